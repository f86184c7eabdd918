#pragma once
// The flow of many images (plane_image.hpp, curvature_image.hpp) at many points.

#include "base/lanes.hpp"
#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"

#include <vector>

namespace asterflow {

// velocity += the flow of all images, in vector lanes of targets. Images have their places from `origin`.
template <class Real, class Image>
void add_image_flows(char const* label, std::vector<Image> const& images, Vec3d origin, ConstPoints targets, Points velocity) {
  auto const n = static_cast<long>(targets.size());
  parallel_for(label, (n + n_lane<Real> - 1) / n_lane<Real>, [&](long block) {
    long const first = block * n_lane<Real>, count = std::min(n_lane<Real>, n - first);
    auto const x = gather<Real>(targets, first, count, origin);
    LanesOfVectors<Real> u;
    for (Image const& image : images) image.add(x, u);
    add_lanes(Stokeslet::prefactor, u, first, count, velocity);
  });
}

}  // namespace asterflow
