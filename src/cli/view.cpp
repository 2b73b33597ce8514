#include "cli/view.h"

#include <iostream>
#include <memory>

#include "cli/exit_codes.h"
#include "cli/outputs.h"
#include "lightmap/atomic_file.h"
#include "scene/printable.h"
#include "view/lit_scene.h"
#include "view/write_page.h"

namespace hemirad {
namespace {

struct ViewOptions {
    std::filesystem::path scene, output;  ///< output empty: the scene's name with .html, here
    std::optional<std::filesystem::path> lightmap;
    bool quiet = false;
};

int view(ViewOptions options) {
    if (options.output.empty()) options.output = options.scene.stem().string() + ".html";
    check_ending("--output", options.output, {".html"});
    check_distinct(options.scene, {options.output});
    check_writable(options.output);
    const LitScene lit = read_lit_scene(options.scene, options.lightmap);
    keep_side_files(lit.scene, {options.output});
    const auto snapshots = read_snapshots(lit);
    write_page(options.output, lit, snapshots);
    if (options.quiet) return kDone;
    std::cerr << printable(options.output.string()) << ": open it in a browser";
    if (!snapshots.empty()) std::cerr << "; " << snapshots.size() << " snapshots to play";
    std::cerr << '\n';
    return kDone;
}

}  // namespace

void add_lit_scene(CLI::App& command, std::filesystem::path& scene,
                   std::optional<std::filesystem::path>& lightmap) {
    require(add_text(command, {"SOLVED", "", "the .glb or .gltf of hemirad solve --gltf"}, scene));
    add_text(command, {"--lightmap", "FILE.exr", "its light [what SOLVED names]"}, lightmap);
}

void add_view(CLI::App& app, Command& chosen) {
    auto& command = add_command(app, "view", "a solved scene as a page for a browser");
    const auto options = std::make_shared<ViewOptions>();
    add_lit_scene(command, options->scene, options->lightmap);
    add_text(command, {"-o,--output", "FILE.html", "the page [SOLVED's name, here]"},
             options->output);
    add_flag(command, "-q,--quiet", options->quiet, "say nothing but warnings and faults");
    on_chosen(command, [&chosen, options] { chosen = [options] { return view(*options); }; });
}

}  // namespace hemirad
