#include "surface/surface.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {

Surface::Surface(std::shared_ptr<Shape const> shape, int order) : shape_(std::move(shape)), grid_(order) {
  for (int j = 0; j < grid_.n_ring(); ++j) {
    double const theta = grid_.polar_angles()[j];
    double const cell = grid_.ring_weights()[j] / std::sin(theta) * 2.0 * std::numbers::pi / grid_.n_azimuth();
    for (int k = 0; k < grid_.n_azimuth(); ++k) {
      SurfacePatch const patch = shape_->patch(theta, grid_.azimuth(k));
      double const stretch = norm(patch.area_vector);
      nodes_.push_back(patch.position);
      normals_.push_back(patch.area_vector / stretch);
      weights_.push_back(cell * stretch);
      area_ += weights_.back();
      volume_ += weights_.back() * dot(nodes_.back() - shape_->centre(), normals_.back()) / 3.0;
    }
  }
}

}  // namespace asterflow
