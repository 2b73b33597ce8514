#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formfactor/form_factors.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// What the rows and columns of a matrix stand for, and which are to be listed.
struct FactorSurfaces {
    std::vector<std::string> names;       ///< [surface]
    std::vector<std::uint32_t> of_patch;  ///< [patch] surface
    std::vector<double> emittance;        ///< [surface] 1 - reflectance, mean over bands and area
    std::vector<bool> is_back;            ///< [surface]
    std::vector<bool> as_from, as_to;     ///< [surface]

    std::size_t size() const { return names.size(); }
};

/// Patches of one name are one surface, in file order: the name of their object or, where the scene
/// has but one object and several materials, of their material. Backs have names of their own,
/// "NAME (back)", after all others: what they hide is seen to be hidden, but only those of
/// double-sided materials are rows. Obstructions are neither rows nor columns.
FactorSurfaces named_surfaces(const Scene& scene, const Mesh& mesh);

/// Every patch is a surface, named "#0", "#1" and so on.
FactorSurfaces single_patches(const Scene& scene, const Mesh& mesh);

/// F_AB = sum over i in A of A_i / A_A times the sum over j in B of F_ij. `factors` has a row for
/// all patches of a surface or for none; it then is a row here.
FormFactors gathered(const FormFactors& factors, const FactorSurfaces& surfaces);

/// The square matrix of the surfaces that are listed both as rows and as columns, numbered anew.
/// What went to others is in no row.
FormFactors among_listed(const FormFactors& factors, const FactorSurfaces& surfaces);

}  // namespace hemirad
