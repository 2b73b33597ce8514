#pragma once

#include <string_view>

namespace hemirad {

/// What a page is made of, as it was when the program was built: page.html, page.js, three.min.js,
/// OrbitControls.js; empty for any other name.
std::string_view page_part(std::string_view file);

}  // namespace hemirad
