#include "scene/face_warnings.h"

#include <sstream>

namespace hemirad::meshing {
namespace {

constexpr std::uint32_t kInFull = 5;

std::string name_of(const Scene& scene, const Face& face) {
    const bool named = face.object < scene.objects.size() && !scene.objects[face.object].empty();
    return named ? '"' + scene.objects[face.object] + '"' : '#' + std::to_string(face.object);
}

}  // namespace

std::string place_text(const glm::dvec3& at) {
    std::ostringstream text;
    text.precision(9);
    text << '(' << at.x << ", " << at.y << ", " << at.z << ')';
    return text.str();
}

void FaceWarnings::add(std::uint32_t face) {
    if (++count_ > kInFull) return;
    const Face& faulty = scene_.faces[face];
    std::ostringstream line;
    line << scene_.file << ": face " << face << " of " << name_of(scene_, faulty);
    if (!faulty.vertices.empty())
        line << " at " << place_text(scene_.positions[faulty.vertices.front()]);
    line << ' ' << what_;
    lines_.push_back(line.str());
}

void FaceWarnings::append_to(std::vector<std::string>& warnings) const {
    warnings.insert(warnings.end(), lines_.begin(), lines_.end());
    if (count_ > kInFull)
        warnings.push_back(scene_.file + ": and " + std::to_string(count_ - kInFull) +
                           " more faces: each " + what_);
}

}  // namespace hemirad::meshing
