#pragma once

#include <ostream>

#include "formfactor/factor_surfaces.h"

namespace hemirad {

/// CSV: from,to,form_factor for each pair that is not 0, or for every pair of fronts; then
/// from,outside,value for each row. 9 significant digits, as in the others.
void write_factors_csv(std::ostream& out, const FormFactors& factors,
                       const FactorSurfaces& surfaces, bool every_pair);

/// View3D's text: header, areas, a line of factors a row, emittances; of the surfaces that are rows
/// and columns.
void write_view3d(std::ostream& out, const FormFactors& factors, const FactorSurfaces& surfaces);

/// The same with a line `i j F`, from 1, for each factor that is not 0.
void write_view3d_sparse(std::ostream& out, const FormFactors& factors,
                         const FactorSurfaces& surfaces);

}  // namespace hemirad
