#pragma once
// The cortex as plus ends meet it: the periphery moved inwards by a margin, so that the fluid between stays resolved.

#include "surface/shapes.hpp"

#include <memory>

namespace asterflow {

// What a point near the cortex sees: the tangent plane at the closest point.
struct NearCortex {
  double distance = 0.0;  // um, positive inside
  Vec3d normal{};         // outward unit normal
};

class CortexSurface {
 public:
  CortexSurface(std::shared_ptr<Shape const> shape, double margin) : shape_(std::move(shape)), margin_(margin) {}

  NearCortex near(Vec3d x) const {
    ClosestPoint const closest = shape_->closest_point(x);
    return {-closest.distance - margin_, closest.normal};
  }
  // The point at that distance inside the surface which is closest to x, um.
  Vec3d at_distance(Vec3d x, double distance) const {
    ClosestPoint const closest = shape_->closest_point(x);
    return closest.position - (distance + margin_) * closest.normal;
  }
  Shape const& shape() const { return *shape_; }

 private:
  std::shared_ptr<Shape const> shape_;
  double margin_;  // um
};

}  // namespace asterflow
