#pragma once
// Gaps between the surfaces of a scene, for the checks that bodies neither overlap nor leave the periphery.

#include "body/body_spec.hpp"
#include "surface/shapes.hpp"

#include <memory>

namespace asterflow {

// A shape at its place in the laboratory.
class PlacedShape {
 public:
  explicit PlacedShape(BodySpec const& body);
  explicit PlacedShape(ShapeSpec const& periphery);  // at the origin

  double signed_distance(Vec3d x) const;        // um, negative inside
  Vec3d point(double theta, double phi) const;  // um, of the surface
  Vec3d position() const { return position_; }
  double size() const { return shape_->size(); }  // um, largest distance of the surface from the centre

 private:
  Vec3d to_body(Vec3d x) const;
  Vec3d to_laboratory(Vec3d x) const;

  std::shared_ptr<Shape const> shape_;
  Vec3d position_;
  Eigen::Matrix3d rotation_;
};

// um; negative when the two overlap.
double gap_between(PlacedShape const& a, PlacedShape const& b);

// um; negative when a point of the inner surface is outside the outer one.
double gap_inside(PlacedShape const& inner, PlacedShape const& outer);

}  // namespace asterflow
