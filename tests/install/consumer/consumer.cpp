#include <iostream>

#include "lightmap/rasterize.h"
#include "mp1map/device.h"
#include "scene/read_scene.h"
#include "solver/solver.h"

int main(int, char** argv) {
    using namespace hemirad;
    const auto mesh = build_mesh(read_scene(argv[1]), {});
    ProgressiveSolver solver(mesh, {.resolution = 64}, mp1map::Device::open(""));
    solver.solve([](const Progress&) { return true; });

    const auto lightmap =
        rasterize(mesh, solver.solution(), lay_out_charts(mesh), Quantity::irradiance);

    std::cout << lightmap.texel_count() << " texels\n";
    return lightmap.texel_count() > 0 ? 0 : 1;
}
