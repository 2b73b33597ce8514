#include "scene/outlines.h"

#include <algorithm>

namespace hemirad::meshing {
namespace {

// Repeated corners and, where the outline goes a way and straight back, the tip of that spike.
void remove_repeats(std::vector<std::uint32_t>& corners) {
    for (std::size_t i = 0, kept = 0; corners.size() > 2 && kept < corners.size();) {
        const std::size_t n = corners.size();
        const bool repeated = corners[i] == corners[(i + 1) % n];
        const bool spike = corners[(i + n - 1) % n] == corners[(i + 1) % n];
        if (repeated || spike) {
            corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
            kept = 0;
        } else {
            ++i;
            ++kept;
        }
        i %= corners.size();
    }
}

/// An outline from its lowest corner on, towards the lower of that corner's neighbours.
class Canonical {
  public:
    explicit Canonical(std::span<const std::uint32_t> outline)
        : outline_(outline), size_(outline.size()) {
        start_ = static_cast<std::size_t>(std::ranges::min_element(outline) - outline.begin());
        reversed_ = outline[(start_ + size_ - 1) % size_] < outline[(start_ + 1) % size_];
    }
    std::size_t size() const { return size_; }
    bool reversed() const { return reversed_; }
    std::uint32_t operator[](std::size_t i) const {
        return outline_[(start_ + (reversed_ ? size_ - i : i)) % size_];
    }

  private:
    std::span<const std::uint32_t> outline_;
    std::size_t size_, start_;
    bool reversed_;
};

bool same_corners(const Canonical& a, const Canonical& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] != b[i]) return false;
    return true;
}

struct HashedFace {
    std::uint64_t hash;
    std::uint32_t face;
    auto operator<=>(const HashedFace&) const = default;
};

// FNV-1a, a corner at a time; equal hashes are compared corner by corner afterwards.
std::uint64_t hash_of(const Canonical& outline) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (std::size_t i = 0; i < outline.size(); ++i) hash = (hash ^ outline[i]) * 0x100000001b3u;
    return hash;
}

std::vector<HashedFace> hash_faces(const Outlines& outlines) {
    std::vector<HashedFace> hashed;
    hashed.reserve(outlines.face_count());
    for (std::uint32_t face = 0; face < outlines.face_count(); ++face)
        if (!outlines[face].empty()) hashed.push_back({hash_of(Canonical(outlines[face])), face});
    std::ranges::sort(hashed);
    return hashed;
}

// Faces of one hash, by number: the first of each shape and direction is an original.
void mark_twins(const Outlines& outlines, std::span<const HashedFace> same_hash,
                std::vector<Twin>& twins) {
    std::vector<std::uint32_t> originals;
    for (const auto& [hash, face] : same_hash) {
        const Canonical outline(outlines[face]);
        for (const std::uint32_t original : originals) {
            const Canonical other(outlines[original]);
            if (!same_corners(outline, other)) continue;
            if (outline.reversed() == other.reversed()) {
                twins[face] = Twin::repeats;
                break;
            }
            twins[face] = twins[original] = Twin::reversed;
        }
        if (twins[face] != Twin::repeats) originals.push_back(face);
    }
}

}  // namespace

Outlines outline_faces(const std::vector<Face>& faces,
                       const std::vector<std::uint32_t>& vertex_of_position) {
    Outlines outlines;
    outlines.first.reserve(faces.size() + 1);
    outlines.first.push_back(0);
    std::vector<std::uint32_t> corners;
    for (const Face& face : faces) {
        corners.clear();
        for (const std::uint32_t position : face.vertices)
            corners.push_back(vertex_of_position[position]);
        remove_repeats(corners);
        if (corners.size() > 2)
            outlines.corners.insert(outlines.corners.end(), corners.begin(), corners.end());
        outlines.first.push_back(static_cast<std::uint32_t>(outlines.corners.size()));
    }
    return outlines;
}

std::vector<Twin> find_twins(const Outlines& outlines) {
    std::vector<Twin> twins(outlines.face_count(), Twin::none);
    const auto hashed = hash_faces(outlines);
    for (std::size_t begin = 0, end = 0; begin < hashed.size(); begin = end) {
        while (end < hashed.size() && hashed[end].hash == hashed[begin].hash) ++end;
        if (end - begin > 1) mark_twins(outlines, {&hashed[begin], end - begin}, twins);
    }
    return twins;
}

}  // namespace hemirad::meshing
