#pragma once

namespace mp1map {

/// PoCL keeps compiled kernels below the user's home and offers no device at all where it cannot
/// write there. Gives it a private folder below the temporary one in that case. To be called
/// before the first look at a platform; does nothing where the user chose a POCL_CACHE_DIR.
void provide_compile_cache();

}  // namespace mp1map
