#pragma once

#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "errors.h"
#include "scene/printable.h"
#include "scene/scene.h"

namespace hemirad::fuzz {

inline void require(bool holds, const char* promise) {
    if (!holds) throw std::logic_error(promise);
}

/// A fault is told in one line that a terminal shows whole.
inline void require_one_line(std::string_view fault) {
    constexpr std::size_t kLongestLine = 2000;
    require(!fault.empty() && fault.size() < kLongestLine, "a fault of a readable length");
    require(printable(fault) == fault, "a fault of one printable line");
}

/// Either ends well or throws an InputError of one line.
template <class Work>
void answer(const Work& work) {
    try {
        work();
    } catch (const InputError& fault) {
        require_one_line(fault.what());
    }
}

inline bool within(const std::vector<double>& spectrum, double most) {
    for (const double value : spectrum)
        if (!(value >= 0 && value <= most)) return false;
    return true;
}

/// What Scene promises.
inline void require_scene(const Scene& scene) {
    for (const auto& p : scene.positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "finite positions");
    for (const Face& face : scene.faces) {
        require(face.vertices.size() >= 3, "faces of three corners");
        for (const auto vertex : face.vertices)
            require(vertex < scene.positions.size(), "vertices in range");
        require(face.material < scene.materials.size(), "materials in range");
        require(face.object < scene.objects.size(), "objects in range");
    }
    for (const Material& material : scene.materials) {
        require(within(material.reflectance, 1), "reflectances from 0 to 1");
        require(within(material.emission, INFINITY), "emission from 0");
        require(material.reflectance.size() == scene.bands.size(), "a reflectance a band");
    }
}

/// A folder of the process: in TMPDIR or, where that is not set, in memory if there is such a
/// folder. What libFuzzer ends leaves it behind, so tools/fuzz sets TMPDIR and removes that.
class Scratch {
  public:
    Scratch() {
        const std::filesystem::path memory = "/dev/shm";
        const bool in_memory = std::getenv("TMPDIR") == nullptr && std::filesystem::exists(memory);
        const auto base = in_memory ? memory : std::filesystem::temp_directory_path();
        std::string pattern = (base / "hemirad-fuzz-XXXXXX").string();
        require(mkdtemp(pattern.data()) != nullptr, "a scratch folder");
        path_ = pattern;
    }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    std::filesystem::path file(const char* name) const { return path_ / name; }
    std::filesystem::path write(const char* name, std::string_view bytes) const {
        std::ofstream(file(name), std::ios::binary) << bytes;
        return file(name);
    }

  private:
    std::filesystem::path path_;
};

inline const Scratch& scratch() {
    static const Scratch folder;
    return folder;
}

}  // namespace hemirad::fuzz
