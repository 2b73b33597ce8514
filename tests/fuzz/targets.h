#pragma once

#include <array>
#include <string_view>

/// What reads bytes of strangers, each as a function of bytes: libFuzzer's targets (tools/fuzz),
/// and those of the test that runs their corpus and mutations of it (fuzz_test.cpp). InputError is
/// an answer; whatever else is thrown, and what the sanitizers see, is a fault.
namespace hemirad::fuzz {

void read_obj_bytes(std::string_view bytes);
/// A material library.
void read_mtl_bytes(std::string_view bytes);
/// glTF as text and as .glb.
void read_gltf_bytes(std::string_view bytes);
void read_vs3_bytes(std::string_view bytes);
/// As they are, and with the checksum that belongs to them.
void read_checkpoint_bytes(std::string_view bytes);
void read_exr_bytes(std::string_view bytes);
/// What `view` and `render` read: a .glb, with a small lightmap of its own.
void read_solved_bytes(std::string_view bytes);
/// Values of options.
void read_option_bytes(std::string_view bytes);
/// A small scene made of the bytes: its mesh, charts, rims and what the solver makes of patches.
void build_mesh_bytes(std::string_view bytes);

struct Target {
    const char* name;
    void (*take)(std::string_view bytes);
    int mutations;  ///< that the test makes of each seed: what takes a second or two in all
};

inline constexpr auto kTargets = std::to_array<Target>({
    {"obj", read_obj_bytes, 1000},
    {"mtl", read_mtl_bytes, 500},
    {"gltf", read_gltf_bytes, 1000},
    {"vs3", read_vs3_bytes, 1000},
    {"checkpoint", read_checkpoint_bytes, 1000},
    {"exr", read_exr_bytes, 300},
    {"solved", read_solved_bytes, 300},
    {"options", read_option_bytes, 300},
    {"mesh", build_mesh_bytes, 60},
});

}  // namespace hemirad::fuzz
