#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hemirad {

/// Index of the name; throws the InputError `SCENE: OPTION "NAME": ...` that lists names like it.
std::size_t index_of_name(const std::vector<std::string>& names, const std::string& scene,
                          std::string_view option, std::string_view name);

/// Letters to insert, remove or replace (Levenshtein 1966), whatever their case.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace hemirad
