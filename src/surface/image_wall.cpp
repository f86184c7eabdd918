#include "surface/image_wall.hpp"

#include "surface/shell_operator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

double shortest_distance(Shape const& shape) { return shape.size() / shape.aspect_ratio(); }

// Mean of the two directions.
double local_spacing(Surface const& wall, LocalGeometry const& at) {
  return std::numbers::pi * at.stretch / std::sqrt(double(wall.order()) * (wall.grid().n_ring() - 1));
}

double bend(LocalGeometry const& at) { return std::hypot(at.curvature[0], at.curvature[1]); }

double inverse_fourth(double x) { return 1.0 / (x * x * x * x); }

double curved_reach(Surface const& wall, LocalGeometry const& at) {
  return std::pow(inverse_fourth(3.0 * local_spacing(wall, at)) + inverse_fourth(0.7 / bend(at)) +
                      inverse_fourth(0.6 * shortest_distance(wall.shape())), -0.25);
}

}  // namespace

ImageWall::ImageWall(Surface const& wall, Side side, bool wants_curvature)
    : surface_(&wall), is_body_(side == Side::exterior),
      has_curvature_(wants_curvature && !is_body_ && !normals_enter_again()), largest_reach_(0.0) {
  double const spacing = wall.spacing();
  if (is_body_) {
    largest_reach_ = std::min(spacing, 0.6 * shortest_distance(wall.shape()));
    return;
  }
  double sharpest = 0.0, farthest = 0.0;
  for (Vec3d const node : wall.nodes()) {
    LocalGeometry const at = local_geometry(wall.shape(), normalized(wall.shape().shell_point(node).direction));
    sharpest = std::max({sharpest, std::abs(at.curvature[0]), std::abs(at.curvature[1])});
    farthest = std::max(farthest, curved_reach(wall, at));
    largest_bend_ = std::max(largest_bend_, local_spacing(wall, at) * bend(at));
  }
  largest_reach_ = has_curvature_ ? farthest : std::min(1.5 * spacing, 0.45 / sharpest);
}

bool ImageWall::normals_enter_again() const {
  Shape const& shape = surface_->shape();
  for (std::size_t i = 0; i < surface_->size(); ++i)
    for (double distance = 0.02 * shape.size(); distance < 3.0 * shape.size(); distance *= 1.2)
      if (shape.shell_point(surface_->nodes()[i] + distance * surface_->normals()[i]).rho < 1.0) return true;
  return false;
}

double ImageWall::nearby_error() const { return 0.07 * (has_curvature_ ? largest_bend_ * largest_bend_ : largest_bend_); }

double ImageWall::reach(LocalGeometry const& at) const {
  return has_curvature_ ? curved_reach(*surface_, at) : largest_reach_;
}

}  // namespace asterflow
