#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hemirad {

/// Energy of one band, W: emitted = absorbed + escaped + unshot.
struct Ledger {
    double emitted = 0, absorbed = 0, escaped = 0, unshot = 0;
    /// |emitted - absorbed - escaped - unshot| / emitted; 0 where nothing is emitted.
    double residual() const;
};

/// Part of the light: that of one light, or what arrives directly and what does not.
struct SolutionPart {
    enum class Kind { light, direct, indirect };
    Kind kind;
    std::string name;                             ///< the light's
    std::vector<std::vector<double>> irradiance;  ///< [band][patch], W/m^2
    /// [band][patch], W/m^2, with the own emission of the light; of direct light, of all.
    std::vector<std::vector<double>> radiosity;
    std::vector<Ledger> ledger;  ///< [band] of a light; else empty
};

/// Radiosity of every patch of a mesh, finished or so far.
struct Solution {
    std::vector<std::string> bands;               ///< as in the mesh
    std::vector<std::vector<double>> irradiance;  ///< [band][patch], W/m^2
    std::vector<std::vector<double>> radiosity;   ///< [band][patch], W/m^2, own emission included
    std::vector<Ledger> ledger;                   ///< [band]
    /// As asked for: lights add up to the whole, direct and indirect light do, too.
    std::vector<SolutionPart> parts = {};
    std::uint64_t shots = 0;
    /// [patch] those that it made, all elements of one that shoots alike; empty unless counted.
    std::vector<std::uint32_t> shots_of = {};
    double unshot_fraction = 0;  ///< unshot / emitted flux, the largest of the bands
    bool converged = false;      ///< false: stopped by a limit
};

}  // namespace hemirad
