#pragma once
// Imposed flow u(x) = velocity + gradient x of the unbounded fluid.

#include "base/arrays.hpp"
#include "background/background_spec.hpp"

namespace asterflow {

class BackgroundFlow {
 public:
  explicit BackgroundFlow(BackgroundSpec const& spec) : spec_(spec) {}

  Vec3d velocity(Vec3d x) const {
    return spec_.velocity + Vec3d{dot(spec_.gradient[0], x), dot(spec_.gradient[1], x), dot(spec_.gradient[2], x)};
  }
  // Half the vorticity: angular velocity of a small sphere carried along, 1/s.
  Vec3d rotation() const {
    auto const& g = spec_.gradient;
    return 0.5 * Vec3d{g[2].y - g[1].z, g[0].z - g[2].x, g[1].x - g[0].y};
  }
  void add_velocity(ConstPoints x, Points u) const {
    for (std::size_t i = 0; i < x.size(); ++i) u[i] += velocity(x[i]);
  }

 private:
  BackgroundSpec spec_;
};

}  // namespace asterflow
