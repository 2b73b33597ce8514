#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "errors.h"
#include "scene/cut_surface.h"
#include "scene/edges.h"
#include "scene/face_warnings.h"
#include "scene/find_contacts.h"
#include "scene/find_overlaps.h"
#include "scene/find_parts.h"
#include "scene/flat_faces.h"
#include "scene/group_flats.h"
#include "scene/input_file.h"
#include "scene/lay_grid.h"
#include "scene/limit_reflectance.h"
#include "scene/mesh.h"
#include "scene/move_onto_edges.h"
#include "scene/number_planes.h"
#include "scene/outlines.h"
#include "scene/precision.h"
#include "scene/vertex_welder.h"

namespace hemirad::meshing {
namespace {

/// Of a surface.
struct SplitDepths {
    Depths elements, shooters;
};

enum class Back { none, absorber, mirror };

double total_area(const Scene& scene) {
    double total = 0;
    for (const Face& face : scene.faces)
        if (face.vertices.size() > 2)
            total += glm::length(area_vector(face.vertices, scene.positions));
    return total;
}

Depths mirrored(Depths depths, std::uint32_t columns) {
    for (auto row = depths.begin(); row != depths.end(); row += columns)
        std::reverse(row, row + columns);
    return depths;
}

/// Turns a scene into a mesh, a stage a function, in the order of `run`.
class Mesher {
  public:
    Mesher(const Scene& scene, const MeshSettings& settings, std::vector<SplitDepths> depths = {})
        : scene_(scene),
          settings_(settings),
          depths_(std::move(depths)),
          precision_(precision_of(scene, settings.weld)),
          vertices_(precision_.weld, scene.positions.size()) {}

    Mesh run() {
        describe_scene();
        check_sizes();
        flatten_faces();
        const auto edges = edges_of(faces_);
        parts_ = find_parts(scene_, faces_, edges, vertices_.positions(), precision_);
        groups_ = std::isinf(settings_.patch_size)
                      ? group_singly(faces_)
                      : group_coplanar(scene_, faces_, edges, vertices_.positions(), precision_);
        contacts_.emplace(faces_, edges, groups_, vertices_.positions(), precision_);
        add_fronts();
        if (mesh_.patches.empty())
            throw InputError(scene_.file + ": no face is wide enough to be cut into patches of " +
                             number(settings_.patch_size) + " m");
        add_backs();
        look_for_contacts_left();
        forget_lone_shooters();
        combine_fragments();
        keep_used_vertices();
        number_planes(precision_, mesh_);
        look_for_overlaps();
        look_for_inside_out();
        look_for_slender_patches();
        mesh_.parts = std::move(parts_.parts);
        mesh_.closed = parts_.encloses_all;
        return std::move(mesh_);
    }

  private:
    void describe_scene() {
        mesh_.bands = scene_.bands;
        mesh_.weld = precision_.weld;
        mesh_.objects = scene_.objects;
        mesh_.face_count = static_cast<std::uint32_t>(scene_.faces.size());
        mesh_.warnings = scene_.warnings;
        limit_reflectance(scene_, settings_.max_reflectance, mesh_);
        const std::vector<double> black(scene_.bands.size(), 0.0);
        mesh_.materials.push_back({"back", black, black, false});
    }

    void check_sizes() {
        if (settings_.patch_size == 0) settings_.patch_size = default_patch_size(scene_);
        if (settings_.element_size == 0)
            settings_.element_size = std::numeric_limits<double>::infinity();
        check_size(settings_.patch_size, "patch", "patches");
        check_size(std::ldexp(settings_.element_size, -int(settings_.split_levels)), "element",
                   "elements");
    }

    void check_size(double size, const std::string& what, const std::string& plural) {
        constexpr double kLeastInPrecisions = 8;  // or vertices on neighbouring lines could weld
        if (!(size > kLeastInPrecisions * precision_.plane))
            throw InputError(scene_.file + ": " + what + " size " + number(size) +
                             " m is not above the precision of the coordinates, " +
                             number(kLeastInPrecisions * precision_.plane) +
                             " m; where they are more precise, --weld says so");
        if (total_area(scene_) > kMostMeshPatches * size * size)
            throw InputError(scene_.file + ": " + what + " size " + number(size) +
                             " m is too small: there would be more than 100 million " + plural);
    }

    // Those of no face may lie beyond what the weld of the others can number.
    void weld_positions() {
        constexpr std::uint32_t kUnused = 0xffffffffu;
        std::vector<bool> is_used(scene_.positions.size());
        for (const Face& face : scene_.faces)
            for (const std::uint32_t position : face.vertices) is_used[position] = true;
        vertex_of_position_.assign(scene_.positions.size(), kUnused);
        for (std::size_t i = 0; i < scene_.positions.size(); ++i) {
            if (!is_used[i]) continue;
            const glm::dvec3& position = scene_.positions[i];
            vertex_of_position_[i] = vertices_.add(position);
            if (vertices_[vertex_of_position_[i]] != position) ++mesh_.input.welded;
        }
    }

    void flatten_faces() {
        weld_positions();
        const Outlines outlines = outline_faces(scene_.faces, vertex_of_position_);
        mesh_.input.moved = move_onto_edges(outlines, precision_, vertices_);
        faces_ = flatten(scene_, outlines, vertices_.positions(), precision_);
        if (faces_.flats.empty()) throw InputError(scene_.file + ": no face has an area");
        mesh_.input.degenerate = faces_.degenerate_count;
        mesh_.input.crossing = faces_.crossing_count;
        mesh_.input.duplicate = faces_.duplicate_count;
        mesh_.input.split = faces_.split_count;
        mesh_.dropped_degenerate = faces_.degenerate_count + faces_.crossing_count;
        mesh_.dropped_duplicate = faces_.duplicate_count;
        mesh_.warnings.insert(mesh_.warnings.end(), faces_.warnings.begin(), faces_.warnings.end());
    }

    Grids grids_of(const Group& group) {
        Grids grids{lay_grid(scene_, faces_, group, vertices_.positions(), precision_,
                             settings_.patch_size),
                    {}};
        const Surface elements =
            divide_cells(scene_, grids.patches, precision_, settings_.element_size);
        for (std::uint32_t level = 0; level <= settings_.split_levels; ++level)
            grids.elements.push_back(halve_cells(scene_, elements, level));
        for (std::uint32_t level = 0; level < settings_.split_levels; ++level)
            grids.split_shooters.push_back(shooters_in(grids));
        const auto index = static_cast<std::uint32_t>(&group - groups_.data());
        const Sides sides = back_of(group) == Back::mirror ? Sides::both : Sides::front;
        if (!std::isinf(settings_.patch_size))
            grids.contacts = contacts_->on(index, grids.patches, sides);
        grids.elements.back().walls = contacts_->walls_on(index, grids.patches, sides);
        return grids;
    }

    /// The next of its grids of shooters.
    static Surface shooters_in(const Grids& grids) {
        const Surface& last =
            grids.split_shooters.empty() ? grids.patches : grids.split_shooters.back();
        for (const Surface& elements : grids.elements)
            if (elements.columns > last.columns || elements.rows > last.rows)
                return part_cells(last, elements);
        return last;
    }

    CutSurface cut(const Group& group, Grids grids) {
        const auto merging = std::isinf(settings_.patch_size) ? Merging::none : Merging::in_cells;
        return cut_surface(faces_, group, std::move(grids), merging, precision_, vertices_);
    }

    /// Of the group that comes next: of the next surface, if the group is that one, and not one of
    /// which nothing was left.
    SplitDepths depths_for(const Surface& grid) const {
        const std::size_t next = mesh_.surfaces.size();
        const std::size_t cells = std::size_t{grid.columns} * grid.rows;
        if (next >= depths_.size() || depths_[next].elements.size() != cells) return {};
        return depths_[next];
    }

    void add_fronts() {
        for (const Group& group : groups_) {
            const std::size_t index = mesh_.surfaces.size();
            Grids grids = grids_of(group);
            const auto [elements, shooters] = depths_for(grids.elements.back());
            grids.depths = elements;
            grids.shooter_depths = shooters;
            append(cut(group, std::move(grids)), mesh_);
            if (mesh_.surfaces.size() == index) continue;
            front_groups_.push_back(&group);
            for (const std::uint32_t flat : group)
                add_triangles(faces_.flats[flat], static_cast<std::uint32_t>(index));
        }
        std::ranges::stable_sort(mesh_.face_triangles, {}, &FaceTriangle::face);
    }

    void add_triangles(const Flat& flat, std::uint32_t surface) {
        const auto corner_of = corners_of(flat.face);
        for (const auto piece : faces_.pieces(flat))
            for (std::size_t i = 1; i + 1 < piece.size(); ++i)
                mesh_.face_triangles.push_back(
                    {flat.face,
                     surface,
                     {corner_of.at(piece[0]), corner_of.at(piece[i]), corner_of.at(piece[i + 1])}});
    }

    /// By vertex, the first corner of the face that is there.
    std::map<std::uint32_t, std::uint32_t> corners_of(std::uint32_t face) const {
        std::map<std::uint32_t, std::uint32_t> corner_of;
        const auto& corners = scene_.faces[face].vertices;
        for (std::uint32_t i = 0; i < corners.size(); ++i)
            corner_of.try_emplace(vertex_of_position_[corners[i]], i);
        return corner_of;
    }

    void add_backs() {
        for (std::uint32_t front = 0; front < front_groups_.size(); ++front) {
            const Group& group = *front_groups_[front];
            const std::size_t before = mesh_.shooters.size(), surfaces = mesh_.surfaces.size();
            switch (back_of(group)) {
                case Back::none:
                    continue;
                case Back::absorber:
                    append(absorber_behind(group), mesh_);
                    break;
                case Back::mirror:
                    append(mirror_behind(group), mesh_);
                    break;
            }
            if (mesh_.surfaces.size() > surfaces)
                mesh_.surfaces[front].reverse = static_cast<std::uint32_t>(surfaces);
            Part& part = parts_.parts[parts_.part_of_flat[group.front()]];
            part.back_patches += static_cast<std::uint32_t>(mesh_.shooters.size() - before);
        }
    }

    // Nobody sees the inside of a closed solid without a lamp in it, nor the back of a sheet whose
    // other side is modelled too. That holds for double-sided materials as well, which exporters
    // set freely; only `block` trusts no solid, e.g. where objects poke into one another.
    Back back_of(const Group& group) const {
        const Flat& flat = faces_.flats[group.front()];
        const Part& part = parts_.parts[parts_.part_of_flat[group.front()]];
        const bool block = settings_.backfaces == Backfaces::block;
        if (flat.has_reverse || (part.closed && !part.holds_light && !block)) return Back::none;
        if (scene_.materials[scene_.faces[flat.face].material].double_sided) return Back::mirror;
        return settings_.backfaces == Backfaces::cull ? Back::none : Back::absorber;
    }

    // Nothing varies on a black back: one cell.
    CutSurface absorber_behind(const Group& group) {
        constexpr double kUncut = std::numeric_limits<double>::infinity();
        const Surface cell =
            lay_grid(scene_, faces_, group, vertices_.positions(), precision_, kUncut);
        CutSurface back =
            turn_over(cut(group, {.patches = cell, .elements = {cell}, .has_fragments = false}));
        back.surface.material = static_cast<std::uint32_t>(mesh_.materials.size() - 1);
        back.surface.has_chart = false;
        return back;
    }

    CutSurface mirror_behind(const Group& group) {
        Grids grids = grids_of(group);
        const std::uint32_t columns = grids.elements.back().columns;
        const auto [elements, shooters] = depths_for(grids.elements.back());
        grids.depths = mirrored(elements, columns);
        grids.shooter_depths = mirrored(shooters, columns);
        grids.has_fragments = false;
        return turn_over(cut(group, std::move(grids)));
    }

    // But not how often they were split.
    void forget_lone_shooters() {
        if (mesh_.shooters.size() == mesh_.patches.size() &&
            std::ranges::all_of(mesh_.shooters, [](const auto& s) { return s.splits == 0; }))
            mesh_.shooters = {};
    }

    void look_for_contacts_left() {
        if (!contacts_->complete())
            mesh_.warnings.push_back(scene_.file +
                                     ": too many faces touch to cut all along one another");
    }

    void look_for_overlaps() {
        const Overlaps overlaps = find_overlaps(mesh_, precision_);
        mesh_.input.overlapping = static_cast<std::uint32_t>(overlaps.pairs.size());
        for (auto& warning : warnings_of(overlaps, scene_.file, mesh_))
            mesh_.warnings.push_back(std::move(warning));
    }

    void look_for_inside_out() {
        if (!parts_.inside_out) return;
        mesh_.input.inside_out = 1;
        const auto& [part, at] = *parts_.inside_out;
        const auto object = parts_.parts[part].objects.front();
        mesh_.warnings.push_back(scene_.file + ": \"" + mesh_.objects[object] +
                                 "\" encloses everything else, which sees the backs of its faces, "
                                 "such as at " +
                                 place_text(at) + ": a room's faces have to be turned over");
    }

    // A patch seen from the middle of its side, at half of its width, has edges that err by 12.6
    // roundings of half of its length: by 1 % of that width where it is 13,000 times as long.
    void look_for_slender_patches() {
        constexpr double kMostSlender = 1e4;
        std::size_t count = 0, first = 0;
        for (std::size_t i = 0; i < mesh_.patches.size(); ++i) {
            const double longest = longest_edge(mesh_.patches[i].corners, mesh_.vertices);
            if (longest * longest < kMostSlender * mesh_.area(mesh_.patches[i])) continue;
            if (count++ == 0) first = i;
        }
        if (count == 0) return;
        mesh_.warnings.push_back(
            scene_.file + ": " + std::to_string(count) +
            (count == 1 ? " patch is" : " patches are") +
            " more than 10,000 times as long as wide, such as at " +
            place_text(mesh_.centroid(mesh_.patches[first])) +
            ": what is as near to it as it is wide sees it wrongly by per cents; a smaller "
            "--patch-size cuts it");
    }

    void combine_fragments() {
        auto& fragments = mesh_.fragments;
        std::ranges::stable_sort(fragments, {}, [](const Fragment& fragment) {
            return std::pair(fragment.face, fragment.patch);
        });
        std::size_t kept = 0;
        for (std::size_t i = 0; i < fragments.size(); ++i) {
            Fragment& last = fragments[kept ? kept - 1 : 0];
            if (kept && last.face == fragments[i].face && last.patch == fragments[i].patch)
                last.area += fragments[i].area;
            else
                fragments[kept++] = fragments[i];
        }
        fragments.resize(kept);
    }

    void keep_used_vertices() {
        constexpr std::uint32_t kUnused = 0xffffffffu;
        const auto& all = vertices_.positions();
        std::vector<std::uint32_t> new_index(all.size(), kUnused);
        for (const Patch& patch : mesh_.patches)
            for (const std::uint32_t v : patch.corners) new_index[v] = 0;
        for (const Shooter& shooter : mesh_.shooters)
            for (const std::uint32_t v : shooter.corners) new_index[v] = 0;
        for (std::uint32_t v = 0; v < all.size(); ++v) {
            if (new_index[v] == kUnused) continue;
            new_index[v] = static_cast<std::uint32_t>(mesh_.vertices.size());
            mesh_.vertices.push_back(all[v]);
        }
        for (Patch& patch : mesh_.patches)
            for (std::uint32_t& v : patch.corners) v = new_index[v];
        for (Shooter& shooter : mesh_.shooters)
            for (std::uint32_t& v : shooter.corners) v = new_index[v];
    }

    const Scene& scene_;
    MeshSettings settings_;
    std::vector<SplitDepths> depths_;  ///< of each surface, or none
    Precision precision_;
    VertexWelder vertices_;
    std::vector<std::uint32_t> vertex_of_position_;
    FlatFaces faces_;
    Parts parts_;
    std::vector<Group> groups_;
    std::optional<ContactFinder> contacts_;   ///< as soon as there are groups
    std::vector<const Group*> front_groups_;  ///< of each front surface
    Mesh mesh_;
};

// Of what lies in the cells of the surface's patch `i`.
void deepen(Depths& depths, const Surface& surface, std::uint32_t i, std::uint32_t depth) {
    const std::uint32_t side = 1u << surface.scale(i);
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            auto& there = depths[surface.cell_of_patch[i] + y * surface.columns + x];
            there = std::max(there, static_cast<std::uint8_t>(depth));
        }
}

Depths element_depths(const Surface& surface, std::uint32_t levels,
                      const std::vector<bool>& split) {
    Depths depths(std::size_t{surface.columns} * surface.rows, 0);
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) {
        const std::uint32_t scale = surface.scale(i);
        const std::uint32_t more = scale > 0 && split[surface.first_patch + i] ? 1 : 0;
        deepen(depths, surface, i, levels - scale + more);
    }
    return depths;
}

void deepen_shooters(std::vector<SplitDepths>& depths, const Mesh& mesh,
                     const std::vector<bool>& split) {
    for (std::size_t i = 0; i < mesh.shooters.size(); ++i) {
        const Shooter& shooter = mesh.shooters[i];
        const Surface& surface = mesh.surfaces[shooter.surface];
        if (surface.scale_of_patch.empty()) continue;
        const std::uint32_t first = shooter.first_patch - surface.first_patch;
        const std::uint32_t more = !split.empty() && split[i] ? 1 : 0;
        for (std::uint32_t k = first; k < first + shooter.patch_count; ++k)
            deepen(depths[shooter.surface].shooters, surface, k, shooter.splits + more);
    }
}

std::vector<SplitDepths> depths_of(const Mesh& mesh, std::uint32_t levels, const Splits& splits) {
    std::vector<SplitDepths> depths;
    for (const Surface& surface : mesh.surfaces) {
        depths.emplace_back();
        if (surface.scale_of_patch.empty()) continue;
        depths.back().elements = element_depths(surface, levels, splits.elements);
        depths.back().shooters.resize(depths.back().elements.size(), 0);
    }
    deepen_shooters(depths, mesh, splits.shooters);
    return depths;
}

double round_to_two_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    return std::round(value / unit) * unit;
}

}  // namespace
}  // namespace hemirad::meshing

namespace hemirad {

Mesh build_mesh(const Scene& scene, const MeshSettings& settings) {
    return meshing::Mesher(scene, settings).run();
}

Mesh split_mesh(const Scene& scene, const MeshSettings& settings, const Mesh& mesh,
                const Splits& splits) {
    return meshing::Mesher(scene, settings, meshing::depths_of(mesh, settings.split_levels, splits))
        .run();
}

double least_patches(const Scene& scene, const MeshSettings& settings) {
    constexpr double kUncut = std::numeric_limits<double>::infinity();
    const double patch = settings.patch_size > 0 ? settings.patch_size : default_patch_size(scene);
    const double element = settings.element_size > 0 ? settings.element_size : kUncut;
    const double size = std::min(patch, element);
    return meshing::total_area(scene) / (size * size);
}

// 3,000 cells' worth of area: with its borders a Cornell box gets some 3,300 patches.
double default_patch_size(const Scene& scene) {
    constexpr double kCells = 3000;
    const double total = meshing::total_area(scene);
    return total > 0 ? meshing::round_to_two_digits(std::sqrt(total / kCells)) : 1.0;
}

}  // namespace hemirad
