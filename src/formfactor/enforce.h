#pragma once

#include "formfactor/form_factors.h"

namespace hemirad {

/// Least squares: the least change, each factor's weighed by its error (by its value where no error
/// is known), after which A_i F_ij = A_j F_ji, sum of a row + outside = 1 and nothing is negative.
/// Pairs of which neither sees the other, and an outside of 0, stay 0. Needs a row for every patch.
/// Where no factors but those zeros allow it, closure_error() stays.
void enforce(FormFactors& factors);

}  // namespace hemirad
