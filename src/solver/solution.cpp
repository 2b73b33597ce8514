#include "solver/solution.h"

#include <cmath>

namespace hemirad {

double Ledger::residual() const {
    return emitted > 0 ? std::abs(emitted - absorbed - escaped - unshot) / emitted : 0;
}

}  // namespace hemirad
