#pragma once

#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// Which patches nobody can see: of a surface that others stand on, what lies under one of these,
/// looking at the inside of its faces. A dark room that is shut is not hidden: it has an inside.
std::vector<bool> find_hidden(const Mesh& mesh);

}  // namespace hemirad
