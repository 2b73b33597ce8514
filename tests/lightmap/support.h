#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "lightmap/chart_layout.h"
#include "lightmap/lightmap.h"
#include "scene/mesh.h"
#include "solver/solution.h"

namespace hemirad {

/// A folder of its own for each test, gone afterwards.
class InFolder : public testing::Test {
  protected:
    InFolder() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::path(testing::TempDir()) /
                  (std::string("hemirad-") + test->name() + "-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~InFolder() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path file(const std::string& name) const { return folder_ / name; }

    std::set<std::string> names_in_folder() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
            names.insert(entry.path().filename());
        }
        return names;
    }

    std::filesystem::path folder_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::uint32_t add_vertex(Mesh& mesh, const glm::dvec3& position) {
    mesh.vertices.push_back(position);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// A surface in z = 0 without patches, its grid starting at the origin.
inline Surface& add_surface(Mesh& mesh, std::uint32_t columns, std::uint32_t rows,
                            glm::dvec2 cell_size) {
    Surface surface;
    surface.u_axis = {1, 0, 0};
    surface.v_axis = {0, 1, 0};
    surface.normal = {0, 0, 1};
    surface.cell_size = cell_size;
    surface.columns = columns;
    surface.rows = rows;
    surface.first_patch = static_cast<std::uint32_t>(mesh.patches.size());
    return mesh.surfaces.emplace_back(surface);
}

/// Adds a patch to the last surface; corners are given in cells.
inline void add_patch(Mesh& mesh, std::uint32_t cell, const std::vector<glm::dvec2>& corners) {
    Surface& surface = mesh.surfaces.back();
    Patch patch{{}, static_cast<std::uint32_t>(mesh.surfaces.size() - 1)};
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 corner = corners[std::min(i, corners.size() - 1)] * surface.cell_size;
        patch.corners[i] =
            i < corners.size() ? add_vertex(mesh, {corner, 0.0}) : patch.corners[i - 1];
    }
    mesh.patches.push_back(patch);
    surface.cell_of_patch.push_back(cell);
    ++surface.patch_count;
}

inline void add_whole_cell(Mesh& mesh, std::uint32_t column, std::uint32_t row) {
    const double x = column, y = row;
    add_patch(mesh, row * mesh.surfaces.back().columns + column,
              {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}});
}

inline void add_rectangle(Mesh& mesh, std::uint32_t columns, std::uint32_t rows,
                          glm::dvec2 cell_size = {1, 1}) {
    add_surface(mesh, columns, rows, cell_size);
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            add_whole_cell(mesh, column, row);
        }
    }
}

inline Mesh rectangle(std::uint32_t columns, std::uint32_t rows, glm::dvec2 cell_size = {1, 1}) {
    Mesh mesh;
    mesh.bands = {"Y"};
    add_rectangle(mesh, columns, rows, cell_size);
    return mesh;
}

/// One band, `irradiance` of each patch; radiosity is half of it.
inline Solution solution_of(const std::vector<double>& irradiance) {
    Solution solution;
    solution.bands = {"Y"};
    solution.irradiance = {irradiance};
    solution.radiosity = {irradiance};
    for (double& value : solution.radiosity[0]) value /= 2;
    solution.ledger = {{10.0, 6.0, 3.0, 0.9}};
    solution.shots = 12;
    solution.unshot_fraction = 0.09;
    return solution;
}

inline Solution constant_solution(const Mesh& mesh, double value) {
    return solution_of(std::vector<double>(mesh.patches.size(), value));
}

inline std::size_t texel_at(const Lightmap& lightmap, std::uint32_t x, std::uint32_t y) {
    return std::size_t{y} * lightmap.width + x;
}

/// Texels whose values differ, so that a mistaken one shows.
inline Lightmap numbered_lightmap(std::uint32_t width, std::uint32_t height,
                                  const std::vector<std::string>& bands) {
    Lightmap lightmap{width, height, bands, {}, {}};
    for (std::size_t band = 0; band < bands.size(); ++band) {
        auto& values = lightmap.values.emplace_back();
        for (std::size_t i = 0; i < lightmap.texel_count(); ++i) {
            values.push_back(static_cast<float>(i + 1) / 8 + 100.0f * static_cast<float>(band));
        }
    }
    lightmap.coverage.assign(lightmap.texel_count(), 1.0f);
    lightmap.coverage[0] = 0.5f;
    return lightmap;
}

/// The text of the exception that `call` throws, "" where it throws none of that type.
template <typename Exception, typename Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const Exception& error) {
        return error.what();
    }
    return "";
}

}  // namespace hemirad
