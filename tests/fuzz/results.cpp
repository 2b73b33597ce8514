#include "cli/checkpoint_file.h"
#include "cli/option_values.h"
#include "cli/sha256.h"
#include "fuzz/answers.h"
#include "fuzz/targets.h"
#include "lightmap/read_exr.h"
#include "lightmap/write_exr.h"
#include "view/lit_scene.h"
#include "view/render.h"

namespace hemirad::fuzz {
namespace {

void read_checkpoint_of(std::string_view bytes) {
    answer([&] { read_checkpoint(scratch().write("a.state", bytes)); });
}

std::string with_checksum(std::string_view bytes) {
    Sha256 sum;
    sum.add(bytes);
    return std::string(bytes) + sum.digits();
}

std::filesystem::path small_lightmap() {
    constexpr std::uint32_t kSide = 4;
    const std::vector<float> values(kSide * kSide, 1.0f);
    const Lightmap lightmap{kSide, kSide, {"R", "G", "B"}, {values, values, values}, values};
    write_exr(scratch().file("light.exr"), lightmap, {}, PixelType::half);
    return scratch().file("light.exr");
}

}  // namespace

void read_checkpoint_bytes(std::string_view bytes) {
    constexpr std::size_t kDigits = 64;  // of the checksum that a seed ends in
    read_checkpoint_of(bytes);
    read_checkpoint_of(
        with_checksum(bytes.substr(0, bytes.size() - std::min(kDigits, bytes.size()))));
}

void read_exr_bytes(std::string_view bytes) {
    const auto file = scratch().write("a.exr", bytes);
    answer([&] { read_exr(file, {"R", "G", "B"}); });
}

void read_solved_bytes(std::string_view bytes) {
    static const auto lightmap = small_lightmap();
    const auto file = scratch().write("a.glb", bytes);
    answer([&] {
        const LitScene lit = read_lit_scene(file, lightmap);
        constexpr std::size_t kMostFaces = 1000;  // those of a seed; rays are slow
        if (lit.scene.faces.size() > kMostFaces) return;
        const Camera camera = lit.cameras.empty() ? Camera{"own"} : lit.cameras[0];
        render(lit, camera, {.width = 2, .height = 2, .samples = 1});
    });
}

void read_option_bytes(std::string_view bytes) {
    constexpr std::size_t kLongest = 400;  // an argument is the user's own, and repeated whole
    const OptionValue value{"--option", bytes.substr(0, kLongest)};
    answer([&] { whole_number(value, 1, 1000); });
    answer([&] { require(positive_number(value) > 0, "a number above 0"); });
    answer([&] { require(positive_or_infinite(value) > 0, "a number above 0, or inf"); });
    answer([&] { require(fraction(value) < 1, "a fraction"); });
    answer([&] { require(extent(value).width > 0, "an extent"); });
    answer([&] { coordinates(value); });
    answer([&] { one_of(value, {"auto", "block", "cull"}); });
}

}  // namespace hemirad::fuzz
