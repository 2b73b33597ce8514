#include "cli/mesh_options.h"

namespace hemirad {
namespace {

const std::vector<std::string_view> kBackfaces{"auto", "block", "cull"};

}  // namespace

void add_mesh_options(CLI::App& command, MeshSettings& settings) {
    add_value(
        command,
        {"--patch-size", "METRES",
         "longest edge of a patch; inf: every polygon is one patch [from the scene's extent]"},
        [&](const OptionValue& value) { settings.patch_size = positive_or_infinite(value); });
    add_value(command,
              {"--backfaces", "auto|block|cull",
               "whether a patch seen from behind hides what lies beyond [auto: where it is open]"},
              [&](const OptionValue& value) {
                  settings.backfaces = static_cast<Backfaces>(one_of(value, kBackfaces));
              });
    add_value(command,
              {"--weld", "METRES", "closer vertices are one [as precise as the scene's file is]"},
              [&](const OptionValue& value) { settings.weld = positive_number(value); });
    add_value(command, {"--max-reflectance", "R", "reflectances above R are limited to it [0.98]"},
              [&](const OptionValue& value) { settings.max_reflectance = fraction(value); });
}

void add_element_size(CLI::App& command, MeshSettings& settings) {
    add_value(
        command,
        {"--element-size", "METRES",
         "patches shoot as they are and receive on elements, of this longest edge [one each]"},
        [&](const OptionValue& value) { settings.element_size = positive_number(value); });
}

void add_split(CLI::App& command, MeshSettings& settings) {
    constexpr std::uint64_t kMostLevels = 8;
    add_value(command,
              {"--split", "LEVELS",
               "elements are split in four so often, where light changes within them, and patches, "
               "where that matters to what stands near [0]"},
              [&](const OptionValue& value) {
                  settings.split_levels =
                      static_cast<std::uint32_t>(whole_number(value, 0, kMostLevels));
              });
}

std::string name_of(Backfaces backfaces) {
    return std::string(kBackfaces[static_cast<std::size_t>(backfaces)]);
}

}  // namespace hemirad
