#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hemirad {

/// Index of the name; throws the InputError `SCENE: OPTION "NAME": ...` that lists names like it.
std::size_t index_of_name(const std::vector<std::string>& names, const std::string& scene,
                          std::string_view option, std::string_view name);

/// The one that may have been meant: it begins so, or differs by a third of its letters at most.
std::optional<std::string> near_name(const std::vector<std::string>& names, std::string_view name);

/// Letters to insert, remove or replace (Levenshtein 1966), whatever their case.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace hemirad
