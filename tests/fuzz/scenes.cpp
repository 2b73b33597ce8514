#include "fuzz/answers.h"
#include "fuzz/targets.h"
#include "scene/input_file.h"

namespace hemirad::fuzz {
namespace {

InputFile in_scratch(const char* name, std::string_view bytes) {
    return {scratch().file(name), name, std::string(bytes)};
}

template <class Read>
void read_with(const Read& read, const InputFile& file) {
    answer([&] {
        const Scene scene = read(file);
        check_scene(file, scene);
        require_scene(scene);
    });
}

}  // namespace

void read_obj_bytes(std::string_view bytes) { read_with(read_obj, in_scratch("a.obj", bytes)); }

void read_mtl_bytes(std::string_view bytes) {
    scratch().write("library.mtl", bytes);
    read_with(read_obj, in_scratch("a.obj",
                                   "mtllib library.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                   "usemtl white\nf 1 2 3\nusemtl lamp\nf 1 3 2\n"));
}

void read_gltf_bytes(std::string_view bytes) { read_with(read_gltf, in_scratch("a.gltf", bytes)); }

void read_vs3_bytes(std::string_view bytes) { read_with(read_vs3, in_scratch("a.vs3", bytes)); }

}  // namespace hemirad::fuzz
