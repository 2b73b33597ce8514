#pragma once

#include <cstdint>
#include <string>

#include "mp1map/device.h"

namespace mp1map {

/// How proxels are dealt out to the PEs (fig. 1.3).
enum class Layout { cyclic, block };

/// How many patches' parameters the ACU diffuses at a time (sec. 1.5.3): one, a batch, or as many
/// as there are PEs, a level of their stacks.
enum class Broadcast { patch, batch, level };

/// The array of processing elements that the MP-1's would be on this device (sec. 1.4): one
/// work-item a PE, `lanes` proxels wide, and the tile of proxels that one array keeps in its PEs'
/// memory, one layer an area (sec. 1.5.5).
struct PeArray {
    std::uint32_t width = 32, height = 32;            ///< PEs
    std::uint32_t lanes = 1;                          ///< proxels a PE takes at once: 1, 4, 8, 16
    std::uint32_t tile_width = 64, tile_height = 64;  ///< proxels
    std::uint32_t array_count = 1;                    ///< arrays that the patches are dealt out to
    bool is_on_cpu = false;                           ///< whose driver deals groups out in runs

    Layout layout = Layout::cyclic;
    Broadcast broadcast = Broadcast::batch;

    std::uint32_t broadcast_patches() const;
    std::uint32_t pe_count() const { return width * height; }
    std::uint32_t area_width() const { return width * lanes; }
    std::uint32_t area_height() const { return height; }
    std::uint32_t layer_count() const {
        return (tile_width / area_width()) * (tile_height / area_height());
    }
    /// Where the proxel (x, y) of a tile lies in a plural variable: lane, PE, layer.
    std::uint32_t proxel_place(std::uint32_t x, std::uint32_t y) const;
    /// Bytes of local memory a PE holds: depth and owner of its proxels.
    std::uint32_t bytes_per_pe() const { return layer_count() * lanes * 8; }
    std::string description() const;  ///< e.g. "4x1 PEs, 16 lanes, tile 64x64"
};

/// What a user may fix of the array; 0 leaves it to the device.
struct PeArrayRequest {
    std::uint32_t width = 0, height = 0, lanes = 0, tile_width = 0, tile_height = 0;
    Layout layout = Layout::cyclic;
    Broadcast broadcast = Broadcast::batch;
};

/// The array for a device: what was asked for, the rest as measured to be fast (a CPU: few PEs of
/// native width with many layers; a GPU: 32 x 8 PEs of one lane). A tile is at least one area and
/// a whole number of areas. Throws NoSuchDevice where the device cannot hold it.
PeArray fit_pe_array(const DeviceSummary& device, const PeArrayRequest& request);

}  // namespace mp1map
