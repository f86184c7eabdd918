#pragma once
// Where things are in a scene: gaps between its surfaces, and how far a fiber can reach.

#include "body/body_spec.hpp"
#include "surface/shapes.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace asterflow {

// A shape at its place in the laboratory.
class PlacedShape {
 public:
  explicit PlacedShape(BodySpec const& body);
  explicit PlacedShape(ShapeSpec const& periphery);  // at the origin

  double signed_distance(Vec3d x) const;        // um, negative inside
  Vec3d point(double theta, double phi) const;  // um, of the surface
  Vec3d position() const { return position_; }
  Vec3d to_laboratory(Vec3d x) const;             // from the frame of the shape
  Vec3d turn_to_laboratory(Vec3d direction) const;
  double size() const { return shape_->size(); }  // um, largest distance of the surface from the centre
  double least_radius() const { return shape_->size() / shape_->aspect_ratio(); }  // um, least distance

 private:
  Vec3d to_body(Vec3d x) const;

  std::shared_ptr<Shape const> shape_;
  Vec3d position_;
  Eigen::Matrix3d rotation_;
};

// um; negative when the two overlap.
double gap_between(PlacedShape const& a, PlacedShape const& b);

// um; negative when a point of the inner surface is outside the outer one.
double gap_inside(PlacedShape const& inner, PlacedShape const& outer);

// The bodies and the periphery of a scene at their places.
struct PlacedScene {
  std::vector<PlacedShape> bodies;
  std::optional<PlacedShape> periphery;

  PlacedScene(std::vector<BodySpec> const& bodies, ShapeSpec const* periphery);  // null: none

  // Distance to the nearest surface, um; negative inside a body and outside the periphery.
  double clearance(Vec3d x) const;
  // Length of the straight line from x in a unit direction to the first surface, um, at most `limit`. A start on a
  // surface, as that of a fiber on its body, does not count.
  double reach(Vec3d x, Vec3d direction, double limit) const;
};

}  // namespace asterflow
