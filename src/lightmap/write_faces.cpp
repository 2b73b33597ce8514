#include "lightmap/write_faces.h"

#include <glm/geometric.hpp>
#include <ostream>
#include <span>
#include <string>

#include "lightmap/atomic_file.h"
#include "lightmap/part_names.h"
#include "scene/csv.h"

namespace hemirad {
namespace {

struct Shape {
    double area = 0.0;
    glm::dvec3 centroid{};
};

/// Fans of triangles, signed by their direction, so that concave polygons count right.
Shape shape_of(const Scene& scene, const Face& face) {
    const glm::dvec3 apex = scene.positions[face.vertices[0]];
    const auto corner = [&](std::size_t i) { return scene.positions[face.vertices[i]] - apex; };
    glm::dvec3 doubled{};
    for (std::size_t i = 2; i < face.vertices.size(); ++i) {
        doubled += glm::cross(corner(i - 1), corner(i));
    }
    const double length = glm::length(doubled);
    glm::dvec3 moment{};
    for (std::size_t i = 2; i < face.vertices.size(); ++i) {
        const double part = glm::dot(glm::cross(corner(i - 1), corner(i)), doubled / length);
        moment += part * (corner(i - 1) + corner(i)) / 3.0;
    }
    return {length / 2.0, apex + moment / length};
}

double area_mean(std::span<const Fragment> fragments, const std::vector<double>& patch_values) {
    double area = 0.0, sum = 0.0;
    for (const Fragment& fragment : fragments) {
        area += fragment.area;
        sum += fragment.area * patch_values[fragment.patch];
    }
    return sum / area;
}

using Bands = std::vector<std::vector<double>>;

/// Columns of values: a quantity's bands under the column's name and a dot.
struct Quantities {
    std::string prefix;
    const Bands* bands;
};

std::vector<Quantities> quantities_of(const Solution& solution) {
    std::vector<Quantities> quantities{{"irradiance.", &solution.irradiance},
                                       {"radiosity.", &solution.radiosity}};
    const auto names = part_names(solution);
    for (std::size_t part = 0; part < names.size(); ++part) {
        quantities.push_back({names[part] + ".irradiance.", &solution.parts[part].irradiance});
        quantities.push_back({names[part] + ".radiosity.", &solution.parts[part].radiosity});
    }
    return quantities;
}

void write_header(std::ostream& stream, const Solution& solution) {
    stream << "face,object,material,area,cx,cy,cz";
    for (const auto& quantity : quantities_of(solution))
        for (const std::string& band : solution.bands)
            stream << ',' << csv_field(quantity.prefix + band);
    stream << '\n';
}

void write_values(std::ostream& stream, const Shape& shape, std::span<const Fragment> fragments,
                  std::span<const Quantities> quantities) {
    const glm::dvec3& c = shape.centroid;
    for (const double value : {shape.area, c.x, c.y, c.z}) stream << ',' << decimal(value);
    for (const auto& quantity : quantities)
        for (const auto& band : *quantity.bands)
            stream << ',' << decimal(area_mean(fragments, band));
}

void write_row(std::ostream& stream, const Scene& scene, std::size_t index,
               std::span<const Fragment> fragments, std::span<const Quantities> quantities) {
    const Face& face = scene.faces[index];
    stream << index << ',' << csv_field(scene.objects[face.object]) << ','
           << csv_field(scene.materials[face.material].name);
    if (fragments.empty()) {
        std::size_t columns = 4;
        for (const auto& quantity : quantities) columns += quantity.bands->size();
        stream << std::string(columns, ',');
    } else {
        write_values(stream, shape_of(scene, face), fragments, quantities);
    }
    stream << '\n';
}

}  // namespace

void write_faces(const std::filesystem::path& path, const Scene& scene, const Mesh& mesh,
                 const Solution& solution) {
    write_atomically(path, [&](std::ostream& stream) {
        write_header(stream, solution);
        const auto quantities = quantities_of(solution);
        std::size_t first = 0;
        for (std::size_t face = 0; face < scene.faces.size(); ++face) {
            std::size_t last = first;
            while (last < mesh.fragments.size() && mesh.fragments[last].face == face) ++last;
            write_row(stream, scene, face, std::span(mesh.fragments).subspan(first, last - first),
                      quantities);
            first = last;
        }
    });
}

}  // namespace hemirad
