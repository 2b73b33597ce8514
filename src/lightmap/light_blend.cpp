#include "lightmap/light_blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <span>

namespace hemirad {
namespace {

/// Of a cell's area; what is missing is rounding.
constexpr double kFull = 0.999;

glm::dvec2 extent_of(const Surface& surface) {
    return surface.cell_size * glm::dvec2(surface.columns, surface.rows);
}

double longest_cell(const Surface& surface) {
    return std::max(surface.cell_size.x, surface.cell_size.y);
}

/// Of its largest patch.
glm::dvec2 largest_cell(const Surface& surface) {
    const auto& scales = surface.scale_of_patch;
    const auto largest = std::ranges::max_element(scales);
    return surface.cell_size * double(1u << (largest == scales.end() ? 0 : *largest));
}

glm::dvec3 world_of(const Surface& surface, const glm::dvec2& place) {
    return surface.origin + place.x * surface.u_axis + place.y * surface.v_axis;
}

glm::dvec2 place_on(const Surface& surface, const glm::dvec3& point) {
    const glm::dvec3 offset = point - surface.origin;
    return {glm::dot(offset, surface.u_axis), glm::dot(offset, surface.v_axis)};
}

struct Box {
    glm::dvec3 low = glm::dvec3(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
};

/// Of a surface and a cell about it.
Box reach_of(const Surface& surface) {
    Box box;
    const glm::dvec2 extent = extent_of(surface);
    for (const double s : {0.0, extent.x})
        for (const double t : {0.0, extent.y}) {
            const glm::dvec3 corner = world_of(surface, {s, t});
            box.low = glm::min(box.low, corner);
            box.high = glm::max(box.high, corner);
        }
    box.low -= longest_cell(surface);
    box.high += longest_cell(surface);
    return box;
}

/// Whether both, a cell about each, share a place as the axes of the first see it.
bool may_share(const Surface& surface, const Surface& other) {
    const glm::dvec2 about = largest_cell(other), own = largest_cell(surface);
    const glm::dvec2 end = extent_of(other) + about;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const double s : {-about.x, end.x})
        for (const double t : {-about.y, end.y}) {
            const glm::dvec2 corner = place_on(surface, world_of(other, {s, t}));
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    return glm::all(glm::lessThanEqual(low, extent_of(surface) + own)) &&
           glm::all(glm::greaterThanEqual(high, -own));
}

bool touch(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) &&
           glm::all(glm::lessThanEqual(b.low, a.high));
}

int longest_axis(const std::vector<Box>& boxes, std::span<const std::uint32_t> of) {
    Box all;
    for (const std::uint32_t i : of) {
        all.low = glm::min(all.low, boxes[i].low);
        all.high = glm::max(all.high, boxes[i].high);
    }
    const glm::dvec3 size = all.high - all.low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// Along the longest axis, each with those that begin before it ends.
void for_each_touching(const std::vector<Box>& boxes, std::vector<std::uint32_t> of,
                       const auto& visit) {
    const int axis = longest_axis(boxes, of);
    std::ranges::sort(of, {}, [&](std::uint32_t i) { return boxes[i].low[axis]; });
    for (auto a = of.begin(); a != of.end(); ++a)
        for (auto b = a + 1; b != of.end() && boxes[*b].low[axis] <= boxes[*a].high[axis]; ++b)
            if (touch(boxes[*a], boxes[*b])) visit(*a, *b);
}

}  // namespace

LightBlend::LightBlend(const Mesh& mesh, const std::vector<bool>& hidden, Across across)
    : mesh_(mesh),
      hidden_(hidden),
      across_(across),
      neighbours_(mesh.surfaces.size()),
      full_cells_(mesh.surfaces.size()) {
    lookups_.reserve(mesh.surfaces.size());
    for (std::uint32_t i = 0; i < mesh.surfaces.size(); ++i) lookups_.emplace_back(mesh, i);
    find_neighbours();
    for (std::uint32_t i = 0; i < mesh.surfaces.size(); ++i)
        if (!neighbours_[i].empty()) find_full_cells(i);
}

void LightBlend::find_neighbours() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_plane;
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < mesh_.surfaces.size(); ++i) {
        const Surface& surface = mesh_.surfaces[i];
        boxes.push_back(reach_of(surface));
        if (surface.has_chart && surface.plane != kOwnPlane) by_plane[surface.plane].push_back(i);
    }
    for (const auto& [plane, surfaces] : by_plane)
        for_each_touching(boxes, surfaces, [&](std::uint32_t a, std::uint32_t b) {
            if (!may_meet(a, b)) return;
            neighbours_[a].push_back(b);
            neighbours_[b].push_back(a);
        });
    for (auto& neighbours : neighbours_) std::ranges::sort(neighbours);
}

void LightBlend::find_full_cells(std::uint32_t index) {
    const Surface& surface = mesh_.surfaces[index];
    std::vector<double> filled(std::size_t{surface.columns} * surface.rows, 0.0);
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) {
        const std::uint32_t size = 1u << surface.scale(i);
        const double share = mesh_.area(mesh_.patches[surface.first_patch + i]) / size / size;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x)
                filled[surface.cell_of_patch[i] + std::size_t{y} * surface.columns + x] += share;
    }
    const double enough = kFull * surface.cell_size.x * surface.cell_size.y;
    for (const double area : filled) full_cells_[index].push_back(area >= enough);
}

bool LightBlend::may_meet(std::uint32_t a, std::uint32_t b) const {
    const Surface &one = mesh_.surfaces[a], &other = mesh_.surfaces[b];
    return glm::dot(one.normal, other.normal) > 0 &&
           (across_ == Across::all_materials || one.material == other.material) &&
           may_share(one, other) && may_share(other, one);
}

std::uint32_t LightBlend::scale_of(std::uint32_t patch) const {
    const Surface& surface = mesh_.surfaces[mesh_.patches[patch].surface];
    return surface.scale(patch - surface.first_patch);
}

glm::dvec2 LightBlend::cell_size(std::uint32_t patch) const {
    return mesh_.surfaces[mesh_.patches[patch].surface].cell_size * double(1u << scale_of(patch));
}

bool LightBlend::is_needed(std::uint32_t patch, const glm::dvec2& place) const {
    const std::uint32_t index = mesh_.patches[patch].surface;
    const Surface& surface = mesh_.surfaces[index];
    if (lookups_[index].has_wall_near(scale_of(patch), place)) return true;
    if (neighbours_[index].empty()) return false;
    for (const double up : {-0.5, 0.5})
        for (const double right : {-0.5, 0.5}) {
            const glm::dvec2 cell =
                glm::floor((place + glm::dvec2(right, up) * cell_size(patch)) / surface.cell_size);
            if (cell.x < 0 || cell.y < 0 || cell.x >= surface.columns || cell.y >= surface.rows)
                return true;
            if (!full_cells_[index][static_cast<std::size_t>(cell.y * surface.columns + cell.x)])
                return true;
        }
    return false;
}

void LightBlend::blend(std::uint32_t patch, const glm::dvec2& place,
                       std::vector<PatchWeight>& made_of) {
    made_of.clear();
    blend_nodes(patch, place, 1.0, true, made_of);
    if (made_of.empty()) made_of.push_back({patch, 1.0});
}

void LightBlend::blend_nodes(std::uint32_t patch, const glm::dvec2& place, double weight,
                             bool beyond, std::vector<PatchWeight>& made_of) {
    // Half a cell beyond the surface the last cell's centre is still one of the four.
    constexpr double kBeyond = 0.499;
    const glm::dvec2 size = cell_size(patch);
    const glm::dvec2 cells = extent_of(mesh_.surfaces[mesh_.patches[patch].surface]) / size;
    const glm::dvec2 position =
        glm::clamp(place / size, glm::dvec2(-kBeyond), cells + kBeyond) - 0.5;
    const glm::dvec2 low = glm::floor(position), part = position - low;
    const auto column = static_cast<std::int64_t>(low.x), row = static_cast<std::int64_t>(low.y);
    for (const int up : {0, 1})
        for (const int right : {0, 1}) {
            const double share = (right ? part.x : 1 - part.x) * (up ? part.y : 1 - part.y);
            if (share > 0)
                add_node(patch, {column + right, row + up, weight * share, beyond}, made_of);
        }
}

// The part of the cell without patches of its own counts as what lies in its middle.
void LightBlend::add_node(std::uint32_t patch, const Node& node,
                          std::vector<PatchWeight>& made_of) {
    const PatchLookup& lookup = lookups_[mesh_.patches[patch].surface];
    lookup.find_in(scale_of(patch), node.column, node.row, candidates_);
    const glm::dvec2 size = cell_size(patch);
    const double whole = size.x * size.y;
    double missing = whole;
    glm::dvec2 moment = whole * (glm::dvec2(node.column, node.row) + 0.5) * size;
    for (const std::uint32_t own : candidates_) {
        const double area = mesh_.area(mesh_.patches[own]);
        missing -= area;
        moment -= area * lookup.centroid(own);
    }
    const bool has_gap = node.beyond && missing > (1 - kFull) * whole;
    const double share = has_gap ? missing / whole : 0.0;
    add_seen(patch, node.weight * (1 - share), made_of);
    if (has_gap) add_beyond(patch, moment / missing, node.weight * share, made_of);
}

void LightBlend::add_seen(std::uint32_t patch, double weight, std::vector<PatchWeight>& made_of) {
    std::erase_if(candidates_, [&](std::uint32_t other) { return !sees(patch, other); });
    double area = 0;
    for (const std::uint32_t other : candidates_) area += mesh_.area(mesh_.patches[other]);
    for (const std::uint32_t other : candidates_)
        made_of.push_back({other, weight * mesh_.area(mesh_.patches[other]) / area});
}

bool LightBlend::sees(std::uint32_t patch, std::uint32_t other) const {
    if (patch == other) return true;
    const std::uint32_t index = mesh_.patches[patch].surface;
    const Surface& surface = mesh_.surfaces[index];
    const PatchLookup& lookup = lookups_[index];
    return !hidden_[other] &&
           surface.side(patch - surface.first_patch) == surface.side(other - surface.first_patch) &&
           lookup.is_open(lookup.centroid(patch), lookup.centroid(other));
}

void LightBlend::add_beyond(std::uint32_t patch, const glm::dvec2& place, double weight,
                            std::vector<PatchWeight>& made_of) {
    const std::uint32_t found = beyond(patch, place);
    if (found == kNoPatch) return;
    const Surface& own = mesh_.surfaces[mesh_.patches[patch].surface];
    const Surface& there = mesh_.surfaces[mesh_.patches[found].surface];
    blend_nodes(found, place_on(there, world_of(own, place)), weight, false, made_of);
}

std::uint32_t LightBlend::beyond(std::uint32_t patch, const glm::dvec2& place) const {
    const std::uint32_t own = mesh_.patches[patch].surface;
    const Surface& surface = mesh_.surfaces[own];
    const glm::dvec2& from = lookups_[own].centroid(patch);
    if (neighbours_[own].empty() || !lookups_[own].is_open(from, place)) return kNoPatch;
    const glm::dvec3 point = world_of(surface, place), eye = world_of(surface, from);
    for (const std::uint32_t other : neighbours_[own]) {
        const Surface& there = mesh_.surfaces[other];
        const PatchLookup& lookup = lookups_[other];
        const std::uint32_t found = lookup.at(place_on(there, point));
        if (found == kNoPatch || hidden_[found]) continue;
        if (lookup.is_open(place_on(there, eye), lookup.centroid(found))) return found;
    }
    return kNoPatch;
}

}  // namespace hemirad
