#include "formfactor/form_factors.h"

#include <algorithm>
#include <cmath>

namespace hemirad {

double FormFactors::at(std::size_t row, std::uint32_t to) const {
    const auto found = std::ranges::lower_bound(rows[row], to, {}, &FormFactor::to);
    return found != rows[row].end() && found->to == to ? found->value : 0;
}

double reciprocity_error(const FormFactors& factors) {
    double largest = 0;
    for (std::size_t i = 0; i < factors.rows.size(); ++i)
        for (const FormFactor& f : factors.rows[i]) {
            const double there = factors.area[i] * f.value;
            const double back = factors.area[f.to] * factors.at(f.to, std::uint32_t(i));
            const double larger = std::max(factors.area[i], factors.area[f.to]);
            largest = std::max(largest, std::abs(there - back) / larger);
        }
    return largest;
}

double closure_error(const FormFactors& factors) {
    double largest = 0;
    for (std::size_t row = 0; row < factors.rows.size(); ++row) {
        double sum = factors.outside[row];
        for (const FormFactor& f : factors.rows[row]) sum += f.value;
        largest = std::max(largest, std::abs(sum - 1));
    }
    return largest;
}

}  // namespace hemirad
