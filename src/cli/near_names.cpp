#include "cli/near_names.h"

#include <algorithm>
#include <cctype>

#include "errors.h"
#include "scene/printable.h"
#include "scene/short_text.h"

namespace hemirad {
namespace {

constexpr std::size_t kNamed = 5;

char lower_case(char c) { return char(std::tolower(static_cast<unsigned char>(c))); }

std::string nearest(std::vector<std::string> names, std::string_view name) {
    std::ranges::stable_sort(names, {}, [&](const auto& n) { return edit_distance(n, name); });
    return names_in_short(names.size(), kNamed,
                          [&](std::size_t i) { return '"' + printable(names[i]) + '"'; });
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = i;
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const bool same = lower_case(a[i]) == lower_case(b[j]);
            const std::size_t replaced = diagonal + (same ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

std::optional<std::string> near_name(const std::vector<std::string>& names, std::string_view name) {
    constexpr std::size_t kFirstLetters = 4;  // "--" and two more
    const auto differs = [&](const std::string& n) {
        const bool begins = name.size() >= kFirstLetters && n.starts_with(name);
        return begins ? 0 : edit_distance(n, name);
    };
    const auto nearest = std::ranges::min_element(names, {}, differs);
    if (nearest == names.end() || 3 * differs(*nearest) > nearest->size()) return {};
    return *nearest;
}

std::size_t index_of_name(const std::vector<std::string>& names, const std::string& scene,
                          std::string_view option, std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found != names.end()) return std::size_t(found - names.begin());
    throw InputError(scene + ": " + std::string(option) + " \"" + printable(name) +
                     "\": no surface has this name; near it: " + nearest(names, name));
}

}  // namespace hemirad
