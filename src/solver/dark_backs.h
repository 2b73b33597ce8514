#pragma once

#include "scene/mesh.h"

namespace hemirad {

/// Backs that no light comes to, since closed walls are between them and all that emits, lose their
/// charts: every texel there would be 0, however fine the solve. The outsides of a double-sided
/// room are. Where find_rooms() knows of no rooms, none do.
void drop_dark_backs(Mesh& mesh);

}  // namespace hemirad
