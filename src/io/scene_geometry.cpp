#include "io/scene_geometry.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace asterflow {

namespace {

// The least of distance(x) over the points of a surface: the best of a grid of angles, then compass search with
// halved steps. The distance is smooth, so the last step of 1e-5 leaves an error of 1e-10 radii.
template <class Distance>
double least_distance(PlacedShape const& surface, Distance const& distance) {
  constexpr int n_theta = 24, n_phi = 48;
  double step = std::numbers::pi / n_theta, theta = 0.0, phi = 0.0;
  double least = std::numeric_limits<double>::infinity();
  auto const is_better = [&](double new_theta, double new_phi) {
    double const d = distance(surface.point(new_theta, new_phi));
    if (d >= least) return false;
    least = d, theta = new_theta, phi = new_phi;
    return true;
  };
  for (int i = 0; i < n_theta; ++i)
    for (int j = 0; j < n_phi; ++j) is_better((i + 0.5) * step, 2.0 * std::numbers::pi * j / n_phi);
  while (step > 1e-5)
    if (!is_better(theta + step, phi) && !is_better(theta - step, phi) && !is_better(theta, phi + step) &&
        !is_better(theta, phi - step))
      step *= 0.5;
  return least;
}

}  // namespace

PlacedShape::PlacedShape(BodySpec const& body)
    : shape_(make_shape(body.shape)), position_(body.position), rotation_(body.orientation.toRotationMatrix()) {}

PlacedShape::PlacedShape(ShapeSpec const& periphery)
    : shape_(make_shape(periphery)), rotation_(Eigen::Matrix3d::Identity()) {}

Vec3d PlacedShape::to_body(Vec3d x) const {
  Vec3d const r = x - position_;
  Eigen::Vector3d const turned = rotation_.transpose() * Eigen::Vector3d(r.x, r.y, r.z);
  return {turned.x(), turned.y(), turned.z()};
}

Vec3d PlacedShape::turn_to_laboratory(Vec3d direction) const {
  Eigen::Vector3d const turned = rotation_ * Eigen::Vector3d(direction.x, direction.y, direction.z);
  return {turned.x(), turned.y(), turned.z()};
}

Vec3d PlacedShape::to_laboratory(Vec3d x) const { return position_ + turn_to_laboratory(x); }

double PlacedShape::signed_distance(Vec3d x) const { return shape_->signed_distance(to_body(x)); }

Vec3d PlacedShape::point(double theta, double phi) const { return to_laboratory(shape_->point(theta, phi)); }

double gap_between(PlacedShape const& a, PlacedShape const& b) {
  double const apart = norm(a.position() - b.position()) - a.size() - b.size();
  if (apart > 0.0) return apart;  // the spheres around them do not meet
  if (b.signed_distance(a.position()) < 0.0 || a.signed_distance(b.position()) < 0.0) return apart;
  return least_distance(a, [&](Vec3d x) { return b.signed_distance(x); });
}

double gap_inside(PlacedShape const& inner, PlacedShape const& outer) {
  return least_distance(inner, [&](Vec3d x) { return -outer.signed_distance(x); });
}

PlacedScene::PlacedScene(std::vector<BodySpec> const& all_bodies, ShapeSpec const* periphery_shape) {
  for (auto const& body : all_bodies) bodies.emplace_back(body);
  if (periphery_shape) periphery.emplace(*periphery_shape);
}

double PlacedScene::clearance(Vec3d x) const {
  double distance = periphery ? -periphery->signed_distance(x) : std::numeric_limits<double>::infinity();
  for (auto const& body : bodies) distance = std::min(distance, body.signed_distance(x));
  return distance;
}

// Marches by the distance to the nearest surface, which cannot miss one, but at least by `least_step`.
double PlacedScene::reach(Vec3d x, Vec3d direction, double limit) const {
  double const least_step = 1e-5 * limit;
  double reached = 0.0;
  while (reached < limit) {
    double const step = std::min(std::max(clearance(x + reached * direction), least_step), limit - reached);
    if (clearance(x + (reached + step) * direction) < 0.0) return reached;
    reached += step;
  }
  return limit;
}

}  // namespace asterflow
