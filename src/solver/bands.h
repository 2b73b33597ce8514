#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/lights.h"
#include "scene/mesh.h"

namespace hemirad {

/// What is to be known besides the sum of all light.
struct PartSettings {
    Lights lights = Lights::together;
    bool direct = false, indirect = false;  ///< what comes straight from emitters, and the rest
};

inline constexpr std::uint32_t kEveryLight = 0xffffffffu;

/// A band of the device: one of the scene's, of the light of every emitter or of one light's.
struct SolvedBand {
    std::size_t band;  ///< the scene's
    std::uint32_t light = kEveryLight;
    bool reflects = true;  ///< false: every patch is black in it, so that what arrives is direct

    bool operator==(const SolvedBand&) const = default;
};

/// Which bands have to be solved. Those of one light share a solution where their reflectance is
/// equal and its emission proportional: a grey scene is solved once, whatever its file names. Of
/// direct light, reflectance does not matter.
struct BandPlan {
    PartSettings parts;
    LightGroups lights;
    std::vector<SolvedBand> solved;
    /// [light][scene band] index into `solved`; one row, of every light, where they are together.
    std::vector<std::vector<std::size_t>> solution;
    std::vector<std::size_t> direct;  ///< [scene band] index into `solved`; empty: not asked for
};

/// Throws InputError where there is uncountable_light().
BandPlan plan_bands(const Mesh& mesh, const PartSettings& parts = {});

/// What is wrong with a band that emits more or less than numbers of the ledger can hold.
std::optional<std::string> uncountable_light(const Mesh& mesh);

/// Flux that a band's patches emit on their own, W.
double emitted_flux(const Mesh& mesh, std::size_t band);

/// Of the light in a solved band.
double emitted_flux(const Mesh& mesh, const LightGroups& lights, const SolvedBand& solved);

/// Of any band.
bool emits_light(const Mesh& mesh);

/// Own emission of a patch as radiosity, pi * radiance, W/m^2.
double emitted_radiosity(const Mesh& mesh, const Patch& patch, std::size_t band);

/// Of the light in a solved band.
double emitted_radiosity(const Mesh& mesh, const LightGroups& lights, const Patch& patch,
                         const SolvedBand& solved);

/// [band][patch] the same of all patches, of one light alone where one is named.
std::vector<std::vector<double>> emitted_radiosities(const Mesh& mesh,
                                                     const LightGroups& lights = {},
                                                     std::uint32_t light = kEveryLight);

/// Reflectance of a patch as the device holds it.
float reflectance(const Mesh& mesh, const Patch& patch, std::size_t band);

}  // namespace hemirad
