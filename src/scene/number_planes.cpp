#include "scene/number_planes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <set>

#include "scene/frame.h"

namespace hemirad::meshing {
namespace {

/// A face no wider than the precision lies near every plane through it, upright ones included;
/// beyond 30 degrees of tilt nothing counts as lying in a plane.
constexpr double kMostTilt = 0.5;

struct Plane {
    glm::dvec3 point, normal;

    double height(const glm::dvec3& p) const { return glm::dot(p - point, normal); }
};

/// Surfaces in one plane; the point of the plane is the mean of their vertices.
struct Sheet {
    Plane plane;
    double area = 0;
    double radius = 0;  ///< of a sphere about that point that holds them
    std::vector<std::uint32_t> surfaces;

    // What is convex has no more area than width times diameter.
    double least_width() const { return area / (2 * radius); }
};

/// Values under 64-bit keys, several under one, in the order in which they came; strangers may turn
/// up under a key, too.
class Buckets {
  public:
    explicit Buckets(std::size_t expected)
        : ends_(std::bit_ceil(std::max<std::size_t>(expected, 16)), {kNone, kNone}) {}

    void add(std::uint64_t key, std::uint32_t value) {
        const auto link = static_cast<std::uint32_t>(links_.size());
        auto& [first, last] = ends_[slot(key)];
        links_.push_back({value, kNone});
        (first == kNone ? first : links_[last].next) = link;
        last = link;
    }
    /// Until `visit` returns false.
    template <class Visit>
    void for_each(std::uint64_t key, Visit visit) const {
        for (std::uint32_t l = ends_[slot(key)].first; l != kNone; l = links_[l].next)
            if (!visit(links_[l].value)) return;
    }

  private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    struct Link {
        std::uint32_t value, next;
    };
    struct Ends {
        std::uint32_t first, last;
    };
    std::size_t slot(std::uint64_t key) const { return key & (ends_.size() - 1); }

    std::vector<Ends> ends_;
    std::vector<Link> links_;
};

// Multiplicative hashing with the odd integer nearest 2^64 / golden ratio (Knuth vol. 3, 6.4).
template <std::size_t Count>
std::uint64_t hash_of(const std::array<std::int64_t, Count>& indices) {
    std::uint64_t hash = 0;
    for (const std::int64_t index : indices) {
        hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash;
}

std::int64_t cell_of(double coordinate, double size) {
    return static_cast<std::int64_t>(std::floor(coordinate / size));
}

/// Unit normals, either way up, found again by what they are to within an angle. Each is kept in a
/// grid of every size that is asked for.
class Directions {
  public:
    Directions(std::set<int> levels, std::size_t expected)
        : levels_(std::move(levels)), buckets_(expected * levels_.size()) {}

    // Wide enough that the box of `tilt` about a normal touches two cells an axis at most.
    static int level_of(double tilt) {
        return static_cast<int>(std::floor(-std::log2(std::min(tilt, kMostTilt)))) - 1;
    }
    const glm::dvec3& operator[](std::uint32_t direction) const { return normals_[direction]; }

    std::uint32_t add(glm::dvec3 normal) {
        if (glm::dot(normal, kUpper) < 0) normal = -normal;
        const auto direction = static_cast<std::uint32_t>(normals_.size());
        normals_.push_back(normal);
        for (const int level : levels_) buckets_.add(key(level, normal, normal, 0), direction);
        return direction;
    }

    /// Until `visit` returns false; of crowds only the first, which are the largest surfaces'.
    template <class Visit>
    void for_each_near(const glm::dvec3& normal, double tilt, Visit visit) const {
        tilt = std::min(tilt, kMostTilt);
        bool goes_on = true;
        for (const double sign : {1.0, -1.0}) {
            // Only near the rim of the upper half does a normal have neighbours on either side.
            if (sign * glm::dot(normal, kUpper) < -tilt * glm::length(kUpper)) continue;
            visit_cells(sign * normal, tilt, [&](std::uint32_t direction) {
                const glm::dvec3 across = glm::cross(normals_[direction], normal);
                if (goes_on && glm::dot(across, across) <= tilt * tilt) goes_on = visit(direction);
                return goes_on;
            });
        }
    }

  private:
    // Along no plane that people build.
    static constexpr glm::dvec3 kUpper{0.4142, 0.7320, 0.5413};

    template <class Visit>
    void visit_cells(const glm::dvec3& normal, double tilt, Visit visit) const {
        // Tiny faces could lie in any of countless planes; this bounds the time they take.
        constexpr int kMostInACell = 32;
        const int level = level_of(tilt);
        const glm::dvec3 low = normal - tilt, high = normal + tilt;
        std::array<std::uint64_t, 8> keys{};
        for (int corner = 0; corner < 8; ++corner) keys[corner] = key(level, low, high, corner);
        std::ranges::sort(keys);
        const auto repeated = std::ranges::unique(keys);
        for (auto k = keys.begin(); k != repeated.begin(); ++k) {
            int left = kMostInACell;
            buckets_.for_each(*k, [&](std::uint32_t d) { return visit(d) && --left > 0; });
        }
    }
    static std::uint64_t key(int level, const glm::dvec3& low, const glm::dvec3& high, int corner) {
        const double size = std::ldexp(1.0, -level);
        return hash_of<4>({level, cell_of((corner & 1 ? high : low).x, size),
                           cell_of((corner & 2 ? high : low).y, size),
                           cell_of((corner & 4 ? high : low).z, size)});
    }

    std::set<int> levels_;
    std::vector<glm::dvec3> normals_;
    Buckets buckets_;
};

class PlaneFinder {
  public:
    PlaneFinder(const Mesh& mesh, double precision) : mesh_(mesh), precision_(precision) {
        const auto& vertices = mesh.vertices;
        if (vertices.empty()) return;
        origin_ = vertices.front();
        double square = 0;
        for (const auto& p : vertices)
            square = std::max(square, glm::dot(p - origin_, p - origin_));
        parallel_ = precision / std::sqrt(square);
    }

    std::vector<Sheet> run() {
        std::vector<Sheet> sheets;
        for (std::uint32_t s = 0; s < mesh_.surfaces.size(); ++s) sheets.push_back(sheet_of(s));
        // A sweep makes planes better known than those of their pieces were, so that the next one
        // may find more. Where many pieces are one plane, few are left after the first; where
        // there are few joins in a great many, going on would find fewer still.
        constexpr std::size_t kFew = 10000;
        for (std::size_t before = 0, joins = 1; joins > 0;) {
            if (sheets.size() > kFew && joins < before / 16) break;
            before = sheets.size();
            sheets = join(std::move(sheets));
            joins = before - sheets.size();
        }
        return sheets;
    }

  private:
    template <class Visit>
    void for_each_corner(std::uint32_t index, Visit visit) const {
        const Surface& surface = mesh_.surfaces[index];
        for (std::uint32_t i = 0; i < surface.patch_count; ++i)
            for (const std::uint32_t v : mesh_.patches[surface.first_patch + i].corners)
                visit(mesh_.vertices[v]);
    }

    Sheet sheet_of(std::uint32_t index) const {
        const Surface& surface = mesh_.surfaces[index];
        Sheet sheet{{{}, surface.normal}, 0, 0, {index}};
        for (std::uint32_t i = 0; i < surface.patch_count; ++i)
            sheet.area += mesh_.area(mesh_.patches[surface.first_patch + i]);
        centre(sheet);
        return sheet;
    }

    void centre(Sheet& sheet) const {
        const glm::dvec3 base = sheet.surfaces.empty() ? origin_ : corner_of(sheet.surfaces[0]);
        glm::dvec3 sum(0);
        double count = 0, square = 0;
        for (const std::uint32_t s : sheet.surfaces)
            for_each_corner(s, [&](const glm::dvec3& p) { sum += p - base, ++count; });
        sheet.plane.point = base + sum / count;
        for (const std::uint32_t s : sheet.surfaces)
            for_each_corner(s, [&](const glm::dvec3& p) {
                const glm::dvec3 apart = p - sheet.plane.point;
                square = std::max(square, glm::dot(apart, apart));
            });
        sheet.radius = std::sqrt(square);
    }
    const glm::dvec3& corner_of(std::uint32_t surface) const {
        return mesh_.vertices[mesh_.patches[mesh_.surfaces[surface].first_patch].corners[0]];
    }

    bool holds(const Plane& plane, const Sheet& sheet) const {
        if (std::abs(plane.height(sheet.plane.point)) > precision_) return false;
        return std::ranges::all_of(sheet.surfaces, [&](std::uint32_t s) {
            const Surface& surface = mesh_.surfaces[s];
            const auto first = mesh_.patches.begin() + surface.first_patch;
            return std::all_of(first, first + surface.patch_count, [&](const Patch& patch) {
                return std::ranges::all_of(patch.corners, [&](std::uint32_t v) {
                    return std::abs(plane.height(mesh_.vertices[v])) <= precision_;
                });
            });
        });
    }

    // Both planes pass the sheet's vertices within the precision, so over its width they part by
    // no more than twice that on either side.
    double tilt_of(const Sheet& sheet) const {
        return std::clamp(4 * precision_ / sheet.least_width(), 0x1p-40, kMostTilt);
    }

    std::vector<Sheet> join(std::vector<Sheet> sheets) const {
        std::ranges::stable_sort(sheets, std::greater{}, &Sheet::area);
        std::set<int> levels{Directions::level_of(parallel_)};
        for (const Sheet& sheet : sheets) levels.insert(Directions::level_of(tilt_of(sheet)));
        Directions directions(levels, sheets.size());
        Buckets by_offset(sheets.size());
        std::vector<Sheet> joined;
        for (Sheet& sheet : sheets) add(std::move(sheet), directions, by_offset, joined);
        for (Sheet& sheet : joined)
            if (sheet.surfaces.size() > 1) fit(sheet);
        return joined;
    }

    // To the first plane of a known direction that holds it; else it founds one, of a known
    // direction where one is parallel: parallel planes are told apart by their offset alone.
    void add(Sheet sheet, Directions& directions, Buckets& by_offset,
             std::vector<Sheet>& joined) const {
        Sheet* leader = nullptr;
        std::optional<std::uint32_t> parallel;
        const auto visit = [&](std::uint32_t direction) {
            leader = find(directions[direction], direction, sheet, by_offset, joined);
            return leader == nullptr;
        };
        directions.for_each_near(sheet.plane.normal, parallel_, [&](std::uint32_t direction) {
            if (!parallel) parallel = direction;
            return visit(direction);
        });
        if (!leader) directions.for_each_near(sheet.plane.normal, tilt_of(sheet), visit);
        if (leader) return absorb(*leader, sheet);
        const std::uint32_t direction = parallel ? *parallel : directions.add(sheet.plane.normal);
        sheet.plane.normal = directions[direction];
        by_offset.add(offset_key(direction, offset(sheet, directions[direction])),
                      static_cast<std::uint32_t>(joined.size()));
        joined.push_back(std::move(sheet));
    }

    double offset(const Sheet& sheet, const glm::dvec3& normal) const {
        return glm::dot(sheet.plane.point - origin_, normal);
    }
    std::uint64_t offset_key(std::uint32_t direction, double offset) const {
        // Wide enough that what lies within the precision of an offset is seldom in two cells.
        return hash_of<2>({direction, cell_of(offset, 16 * precision_)});
    }

    Sheet* find(const glm::dvec3& normal, std::uint32_t direction, const Sheet& sheet,
                const Buckets& by_offset, std::vector<Sheet>& joined) const {
        const double at = offset(sheet, normal);
        Sheet* found = nullptr;
        const std::uint64_t low = offset_key(direction, at - precision_),
                            high = offset_key(direction, at + precision_);
        const auto visit = [&](std::uint32_t candidate) {
            Sheet& leader = joined[candidate];
            if (leader.plane.normal == normal && holds(leader.plane, sheet)) found = &leader;
            return found == nullptr;
        };
        by_offset.for_each(low, visit);
        if (!found && high != low) by_offset.for_each(high, visit);
        return found;
    }

    static void absorb(Sheet& leader, const Sheet& sheet) {
        leader.area += sheet.area;
        leader.surfaces.insert(leader.surfaces.end(), sheet.surfaces.begin(), sheet.surfaces.end());
    }

    // Least squares; what the largest piece alone says of the plane errs far away from it.
    void fit(Sheet& sheet) const {
        const Plane before = sheet.plane;
        centre(sheet);
        const Frame frame = frame_across(before);
        double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
        for (const std::uint32_t s : sheet.surfaces)
            for_each_corner(s, [&](const glm::dvec3& p) {
                const glm::dvec3 apart = (p - sheet.plane.point) / sheet.radius;
                const double x = glm::dot(apart, frame.u), y = glm::dot(apart, frame.v),
                             z = glm::dot(apart, frame.normal);
                xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z;
            });
        const double determinant = xx * yy - xy * xy;
        const glm::dvec3 normal = determinant * frame.normal - (xz * yy - yz * xy) * frame.u -
                                  (yz * xx - xz * xy) * frame.v;
        if (determinant > 0) sheet.plane.normal = normal / glm::length(normal);
        if (!holds(sheet.plane, sheet)) sheet.plane = before;
    }
    static Frame frame_across(const Plane& plane) {
        const glm::dvec3 upright = glm::abs(plane.normal);
        const glm::dvec3 axis = upright.x < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        return frame_along(plane.point, axis, plane.normal);
    }

    const Mesh& mesh_;
    double precision_;
    glm::dvec3 origin_{0};
    /// Directions that differ by less part by less than the precision across the whole scene.
    double parallel_ = 0;
};

}  // namespace

void number_planes(const Precision& precision, Mesh& mesh) {
    auto sheets = PlaneFinder(mesh, precision.plane).run();
    for (Sheet& sheet : sheets) std::ranges::sort(sheet.surfaces);
    std::ranges::sort(sheets, {}, [](const Sheet& sheet) { return sheet.surfaces.front(); });
    for (std::uint32_t plane = 0; plane < sheets.size(); ++plane)
        for (const std::uint32_t s : sheets[plane].surfaces) mesh.surfaces[s].plane = plane;
}

}  // namespace hemirad::meshing
