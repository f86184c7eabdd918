#pragma once
// A wall as the images of close forces behind it see it: how far from it forces have images, and whether these follow its
// curvature. Nodes that are h apart resolve a force at the distance d to exp(-pi d / h). Images fade out where d = reach:
//   plane images (plane_image.hpp) leave d / radius of a force:
//     reach = min(1.5 h, 0.45 x smallest radius of curvature) inside a cell, min(h, 0.6 b) at a body, which they stay within;
//   curved ones (curvature_image.hpp) leave (d / radius)^2:
//     reach^-4 = (3 h)^-4 + (0.7 / k)^-4 + (0.6 b)^-4, with h and k^2 = k_1^2 + k_2^2 at the foot of the force.
// b is the shortest distance of the wall from the centre: forces stay on the near side of the cell's axis.

#include "surface/local_geometry.hpp"
#include "surface/surface.hpp"

namespace asterflow {

enum class Side;

class ImageWall {
 public:
  // The fluid is on that side of the wall, to which a reference is kept. wants_curvature: granted in a cell whose outward
  // normals do not enter it again.
  ImageWall(Surface const& wall, Side side, bool wants_curvature);

  Surface const& surface() const { return *surface_; }
  bool is_body() const { return is_body_; }
  bool has_curvature() const { return has_curvature_; }

  double reach(LocalGeometry const& at) const;             // um, at that point of the wall
  double largest_reach() const { return largest_reach_; }  // um
  // Largest error of the flow of a force within h of a cell at points as close, over its flow without a cell, about:
  // 0.07 h k where images are plane, 0.07 (h k)^2 where they are curved. Measured (bench_screening).
  double nearby_error() const;

  static constexpr double deepest = 1.28;  // over reach: where images are negligible
 private:
  bool normals_enter_again() const;

  Surface const* surface_;
  bool is_body_, has_curvature_;
  double largest_reach_, largest_bend_ = 0.0;  // um; of h k
};

}  // namespace asterflow
