#include "formfactor/visible_pieces.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

namespace hemirad::formfactor {
namespace {

// Both sides of a plane through the eye.
void split(const glm::dvec3& normal, std::span<const glm::dvec3> piece,
           std::vector<glm::dvec3>& inside, std::vector<glm::dvec3>& outside) {
    inside.clear();
    outside.clear();
    const glm::dvec3* previous = &piece.back();
    double previous_height = glm::dot(normal, *previous);
    for (const glm::dvec3& corner : piece) {
        const double height = glm::dot(normal, corner);
        if (height * previous_height < 0) {
            const glm::dvec3 crossing =
                *previous + (previous_height / (previous_height - height)) * (corner - *previous);
            inside.push_back(crossing);
            outside.push_back(crossing);
        }
        if (height >= 0) inside.push_back(corner);
        if (height <= 0) outside.push_back(corner);
        previous = &corner;
        previous_height = height;
    }
}

}  // namespace

void VisiblePieces::Pieces::clear() {
    corners.clear();
    ends.clear();
}

void VisiblePieces::Pieces::add(std::span<const glm::dvec3> piece) {
    corners.insert(corners.end(), piece.begin(), piece.end());
    ends.push_back(corners.size());
}

std::span<const glm::dvec3> VisiblePieces::Pieces::at(std::size_t index) const {
    const std::size_t begin = index == 0 ? 0 : ends[index - 1];
    return std::span(corners).subspan(begin, ends[index] - begin);
}

void VisiblePieces::begin(std::span<const glm::dvec3> polygon, const glm::dvec3& eye) {
    eye_ = eye;
    pieces_.clear();
    pieces_.add(polygon);
    for (glm::dvec3& corner : pieces_.corners) corner -= eye;
}

bool VisiblePieces::hide_behind(std::span<const glm::dvec3> blocker) {
    cone_.clear();
    for (std::size_t k = 0; k < blocker.size(); ++k)
        cone_.push_back(glm::cross(blocker[(k + 1) % blocker.size()] - eye_, blocker[k] - eye_));
    left_.clear();
    bool taken = false;
    for (std::size_t index = 0; index < pieces_.ends.size(); ++index) {
        const auto piece = pieces_.at(index);
        if (apart(piece) || !cut(piece))
            left_.add(piece);
        else
            taken = true;
    }
    if (taken) std::swap(pieces_, left_);
    return taken;
}

// Outside of one plane of the cone.
bool VisiblePieces::apart(std::span<const glm::dvec3> piece) const {
    return std::ranges::any_of(cone_, [&](const glm::dvec3& normal) {
        return std::ranges::all_of(
            piece, [&](const glm::dvec3& corner) { return glm::dot(normal, corner) <= 0; });
    });
}

// What is outside of a plane is left, what is inside goes on to the next. False, and nothing is
// left, where the piece turns out to pass the cone.
bool VisiblePieces::cut(std::span<const glm::dvec3> piece) {
    const std::size_t corner_count = left_.corners.size(), piece_count = left_.ends.size();
    rest_.assign(piece.begin(), piece.end());
    for (const glm::dvec3& normal : cone_) {
        split(normal, rest_, inside_, outside_);
        if (inside_.size() < 3) {
            left_.corners.resize(corner_count);
            left_.ends.resize(piece_count);
            return false;
        }
        if (outside_.size() >= 3) left_.add(outside_);
        std::swap(rest_, inside_);
    }
    return true;
}

double VisiblePieces::factor(const glm::dvec3& normal) const {
    double sum = 0;
    for (std::size_t index = 0; index < pieces_.ends.size(); ++index)
        sum += lambert_sum(pieces_.at(index), normal);
    return sum;
}

}  // namespace hemirad::formfactor
