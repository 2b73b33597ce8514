#include "formfactor/factor_surfaces.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace hemirad {
namespace {

/// Names of faces, before patches are looked at.
struct Naming {
    bool by_material;
    std::vector<std::string> in_file_order;
};

std::vector<std::uint32_t> used_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    std::vector<std::uint32_t> in_order;
    for (const Face& face : scene.faces) {
        if (!used[face.material]) in_order.push_back(face.material);
        used[face.material] = true;
    }
    return in_order;
}

Naming naming_of(const Scene& scene) {
    const auto materials = used_materials(scene);
    if (scene.objects.size() > 1 || materials.size() < 2) return {false, scene.objects};
    Naming naming{true, {}};
    for (const auto material : materials)
        naming.in_file_order.push_back(scene.materials[material].name);
    return naming;
}

std::string name_of(const Surface& surface, const Scene& scene, const Naming& naming) {
    const bool is_absorber = surface.material >= scene.materials.size();
    const std::string& name = naming.by_material && !is_absorber
                                  ? scene.materials[surface.material].name
                                  : scene.objects[surface.object];
    return surface.is_back ? name + " (back)" : name;
}

/// Names that no surface of the mesh has are left out.
std::vector<std::string> names_in_use(const Scene& scene, const Mesh& mesh, const Naming& naming) {
    std::map<std::string, bool> listed;  // and whether already
    for (const Surface& surface : mesh.surfaces) listed[name_of(surface, scene, naming)] = false;
    std::vector<std::string> candidates = naming.in_file_order, names;
    for (const auto* of : {&naming.in_file_order, &scene.objects})
        for (const std::string& name : *of) candidates.push_back(name + " (back)");
    for (const std::string& name : candidates) {
        const auto found = listed.find(name);
        if (found == listed.end() || found->second) continue;
        found->second = true;
        names.push_back(name);
    }
    return names;
}

double reflectance(const Scene& scene, const Mesh& mesh, std::uint32_t material) {
    const bool is_absorber = material >= scene.materials.size();
    const auto& bands = (is_absorber ? mesh.materials : scene.materials)[material].reflectance;
    return std::accumulate(bands.begin(), bands.end(), 0.0) / double(bands.size());
}

bool is_obstruction(const Scene& scene, const Surface& surface) {
    return std::ranges::find(scene.obstructions, surface.object) != scene.obstructions.end();
}

void set_emittances(const Scene& scene, const Mesh& mesh, FactorSurfaces& surfaces) {
    std::vector<double> area(surfaces.size());
    surfaces.emittance.assign(surfaces.size(), 0);
    for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        const Patch& patch = mesh.patches[i];
        const double patch_area = mesh.area(patch);
        const auto material = mesh.surfaces[patch.surface].material;
        area[surfaces.of_patch[i]] += patch_area;
        surfaces.emittance[surfaces.of_patch[i]] +=
            patch_area * (1 - reflectance(scene, mesh, material));
    }
    for (std::size_t s = 0; s < surfaces.size(); ++s) surfaces.emittance[s] /= area[s];
}

std::vector<double> areas_of(const FormFactors& factors, const FactorSurfaces& surfaces) {
    std::vector<double> area(surfaces.size());
    for (std::size_t i = 0; i < factors.area.size(); ++i)
        area[surfaces.of_patch[i]] += factors.area[i];
    return area;
}

/// Rows of patches, by surface.
std::vector<std::vector<std::size_t>> rows_of(const FormFactors& factors,
                                              const FactorSurfaces& surfaces) {
    std::vector<std::vector<std::size_t>> rows(surfaces.size());
    for (std::size_t row = 0; row < factors.from.size(); ++row)
        rows[surfaces.of_patch[factors.from[row]]].push_back(row);
    return rows;
}

/// A row of the gathered matrix, dense while it is summed.
class RowSum {
  public:
    explicit RowSum(std::size_t count) : value_(count), error_(count), is_hit_(count) {}

    void add(std::uint32_t to, double value, double error) {
        if (!is_hit_[to]) hit_.push_back(to);
        is_hit_[to] = true;
        value_[to] += value;
        error_[to] += error;
    }

    std::vector<FormFactor> take() {
        std::ranges::sort(hit_);
        std::vector<FormFactor> row;
        for (const auto to : hit_) {
            row.push_back({to, float(error_[to]), value_[to]});
            value_[to] = error_[to] = 0;
            is_hit_[to] = false;
        }
        hit_.clear();
        return row;
    }

  private:
    std::vector<double> value_, error_;
    std::vector<bool> is_hit_;
    std::vector<std::uint32_t> hit_;
};

}  // namespace

FactorSurfaces named_surfaces(const Scene& scene, const Mesh& mesh) {
    const Naming naming = naming_of(scene);
    FactorSurfaces surfaces;
    surfaces.names = names_in_use(scene, mesh, naming);
    std::map<std::string, std::uint32_t> index;
    for (const auto& name : surfaces.names) index.emplace(name, std::uint32_t(index.size()));
    surfaces.is_back.assign(surfaces.size(), false);
    surfaces.as_from.assign(surfaces.size(), false);
    surfaces.as_to.assign(surfaces.size(), false);
    for (const Patch& patch : mesh.patches) {
        const Surface& surface = mesh.surfaces[patch.surface];
        const auto s = index.at(name_of(surface, scene, naming));
        surfaces.of_patch.push_back(s);
        surfaces.is_back[s] = surface.is_back;
        const bool is_listed = !is_obstruction(scene, surface);
        if (is_listed) surfaces.as_to[s] = true;
        if (is_listed && surface.has_chart) surfaces.as_from[s] = true;
    }
    set_emittances(scene, mesh, surfaces);
    return surfaces;
}

FactorSurfaces single_patches(const Scene& scene, const Mesh& mesh) {
    FactorSurfaces surfaces;
    for (std::uint32_t i = 0; i < mesh.patches.size(); ++i) {
        const Surface& surface = mesh.surfaces[mesh.patches[i].surface];
        const bool is_listed = !is_obstruction(scene, surface);
        surfaces.names.push_back("#" + std::to_string(i));
        surfaces.of_patch.push_back(i);
        surfaces.is_back.push_back(surface.is_back);
        surfaces.as_from.push_back(is_listed);
        surfaces.as_to.push_back(is_listed);
    }
    set_emittances(scene, mesh, surfaces);
    return surfaces;
}

FormFactors gathered(const FormFactors& factors, const FactorSurfaces& surfaces) {
    FormFactors result{{}, {}, {}, areas_of(factors, surfaces)};
    const auto rows = rows_of(factors, surfaces);
    RowSum sum(surfaces.size());
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
        if (rows[s].empty()) continue;
        double outside = 0;
        for (const std::size_t row : rows[s]) {
            const double share = factors.area[factors.from[row]] / result.area[s];
            outside += share * factors.outside[row];
            for (const FormFactor& f : factors.rows[row])
                sum.add(surfaces.of_patch[f.to], share * f.value, share * f.error);
        }
        result.from.push_back(s);
        result.rows.push_back(sum.take());
        result.outside.push_back(outside);
    }
    return result;
}

FormFactors among_listed(const FormFactors& factors, const FactorSurfaces& surfaces) {
    const auto is_listed = [&](std::uint32_t s) {
        return surfaces.as_from[s] && surfaces.as_to[s];
    };
    std::vector<std::uint32_t> number(surfaces.size());
    FormFactors result;
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
        if (!is_listed(s)) continue;
        number[s] = std::uint32_t(result.area.size());
        result.area.push_back(factors.area[s]);
    }
    for (std::size_t row = 0; row < factors.from.size(); ++row) {
        if (!is_listed(factors.from[row])) continue;
        result.from.push_back(number[factors.from[row]]);
        result.outside.push_back(factors.outside[row]);
        result.rows.emplace_back();
        for (const FormFactor& f : factors.rows[row])
            if (is_listed(f.to)) result.rows.back().push_back({number[f.to], f.error, f.value});
    }
    return result;
}

}  // namespace hemirad
