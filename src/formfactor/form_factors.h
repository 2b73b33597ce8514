#pragma once

#include <cstdint>
#include <vector>

namespace hemirad {

/// F from one polygon to another, with what is known of its error.
struct FormFactor {
    std::uint32_t to;
    float error;  ///< bound of |value - truth| that holds for 99 % of the factors
    double value;
};

/// Factors between all patches of a mesh, or from some of them: a row a `from`, zeros left out.
/// sum of a row + outside = 1.
struct FormFactors {
    std::vector<std::uint32_t> from;            ///< [row] patch
    std::vector<std::vector<FormFactor>> rows;  ///< [row], ascending in `to`
    std::vector<double> outside;                ///< [row] what leaves the scene
    std::vector<double> area;                   ///< [patch], m^2, of every patch of the mesh

    /// F[row][to]; 0 where there is no entry.
    double at(std::size_t row, std::uint32_t to) const;
};

/// Largest |A_i F_ij - A_j F_ji| / max(A_i, A_j) over all pairs. Needs a row for every patch.
double reciprocity_error(const FormFactors& factors);

/// Largest |sum of a row + outside - 1|.
double closure_error(const FormFactors& factors);

}  // namespace hemirad
