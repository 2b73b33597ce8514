#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "kernels/shared.h"
#include "solver/patch_arrays.h"

namespace hemirad {

/// What a hemisphere sees, found by Embree on all cores: a ray through every proxel's centre. Backs
/// hide as fronts do, which culling backs would make no cheaper: for shooters outside of solids.
class PacketCaster {
  public:
    explicit PacketCaster(const PatchArrays& patches);
    ~PacketCaster();

    /// The disks' proxels by the patch that their rays meet, [patch], of all hemispheres whose
    /// origins and axes `aimed` gives; there is one or more. Valid until the next call.
    std::span<const std::int32_t> count(std::span<const device::Shot> aimed,
                                        std::uint32_t resolution);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace hemirad
