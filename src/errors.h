#pragma once

#include <stdexcept>

namespace hemirad {

/// The user's fault: wrong use or bad input. Exit code 1.
/// One line: file, element, reason, e.g. `hall.gltf: material "whte": reflectance 1.20 is above 1`.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A result could not be written: unwritable folder, full disk. Exit code 3.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace hemirad
