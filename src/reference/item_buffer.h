#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reference/projector.h"

/// Form factors from a point by samples of its directions: the paper's hemisphere, and the
/// approximations that it is compared with (sec. 1.3.1). A sample belongs to the nearest polygon
/// that turns its front to the point; back faces hide nothing.
namespace hemirad::reference {

struct PointFactors {
    std::vector<double> values;  ///< [polygon]
    double outside = 0;          ///< of the samples that meet no polygon
    std::uint64_t sample_count = 0;
};

enum class Distance {
    along_ray,  ///< true distance (sec. 1.5.3)
    of_patch,   ///< Spencer's one distance a patch (app. A, [8]): that of the mean of its corners
};

/// Proxels of the base disk, all of the same weight (sec. 1.3.2); samples: those in the disk.
PointFactors hemisphere_factors(const Shooter& shooter, std::span<const Polygon> polygons,
                                int resolution, Distance distance = Distance::along_ray);

/// Cohen and Greenberg's hemicube [2]: a face of N x N pixels and four of N x N / 2, each pixel
/// with its delta form factor; 3 N^2 samples. N is even.
PointFactors hemicube_factors(const Shooter& shooter, std::span<const Polygon> polygons,
                              int resolution);

/// One plane of N x N pixels at distance 1 [6][7], from -half_width to half_width on both axes.
/// What leaves at grazing angles, past the plane, is in no sum.
PointFactors single_plane_factors(const Shooter& shooter, std::span<const Polygon> polygons,
                                  int resolution, double half_width);

}  // namespace hemirad::reference
