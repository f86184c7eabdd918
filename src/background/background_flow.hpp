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
  void add_velocity(ConstPoints x, Points u) const {
    for (std::size_t i = 0; i < x.size(); ++i) u[i] += velocity(x[i]);
  }

 private:
  BackgroundSpec spec_;
};

}  // namespace asterflow
