#include "surface/surface.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

Vec3d product(Eigen::Matrix3d const& a, Vec3d v) {
  Eigen::Vector3d const result = a * Eigen::Vector3d(v.x, v.y, v.z);
  return {result[0], result[1], result[2]};
}

bool is_axisymmetric(Shape const& shape, Grading const& grading) {
  if (shape.aspect_ratio() == 1.0 && norm(shape.centre()) == 0.0) return true;  // about every axis of its frame
  return shape.axisymmetric() && std::abs(grading.frame()(shape.polar_axis(), 0)) > 1.0 - 1e-15;
}

}  // namespace

Surface::Surface(std::shared_ptr<Shape const> shape, SphereGrid const& grid)
    : Surface(shape, grid, Grading(axis_frame(shape->polar_axis()))) {}

Surface::Surface(std::shared_ptr<Shape const> shape, SphereGrid const& grid, Grading const& grading)
    : shape_(std::move(shape)), grid_(grid), grading_(grading), axisymmetric_(is_axisymmetric(*shape_, grading)) {
  for (int j = 0; j < grid_.n_ring(); ++j) {
    double const t = grid_.polar_angles()[j];
    double const cell = grid_.ring_weights()[j] / std::sin(t) * 2.0 * std::numbers::pi / grid_.n_azimuth();
    for (int k = 0; k < grid_.n_azimuth(); ++k) {
      SurfacePatch const at = patch(t, grid_.azimuth(k));
      double const stretch = norm(at.area_vector());
      nodes_.push_back(at.position);
      normals_.push_back(at.area_vector() / stretch);
      weights_.push_back(cell * stretch);
      area_ += weights_.back();
      volume_ += weights_.back() * dot(nodes_.back() - shape_->centre(), normals_.back()) / 3.0;
    }
  }
}

double Surface::spacing() const { return std::numbers::pi * shape_->size() / (grid_.n_ring() - 1); }

SurfacePatch Surface::patch(Grading::PolarAngle ring, double phi) const {
  double const c = std::cos(ring.theta), s = std::sin(ring.theta), cp = std::cos(phi), sp = std::sin(phi);
  SphereImage const image = shape_->image(from_polar({c, s * cp, s * sp}));
  return {image.position, product(image.jacobian, ring.slope * from_polar({-s, c * cp, c * sp})),
          product(image.jacobian, from_polar({0.0, -s * sp, s * cp}))};
}

void Surface::sample_ring(Grading::PolarAngle ring, Eigen::ArrayXd const& cosines, Eigen::ArrayXd const& sines,
                          RingSample& sample) const {
  double const c = std::cos(ring.theta), s = std::sin(ring.theta);
  Eigen::Matrix3d const& frame = grading_.frame();
  sample.directions.resize(cosines.size(), 3);
  for (int i = 0; i < 3; ++i)
    sample.directions.col(i) = c * frame(i, 0) + s * (frame(i, 1) * cosines + frame(i, 2) * sines);
  shape_->sample(sample.directions, sample.positions, sample.areas);
  sample.areas *= s * ring.slope;
}

ClosestAngles Surface::closest_angles(Vec3d x) const {
  ClosestPoint const closest = shape_->closest_point(x);
  Vec3d const d = to_polar(closest.direction);
  return {grading_.grid_angle(std::atan2(std::hypot(d.y, d.z), d.x)), std::atan2(d.z, d.y), closest.distance};
}

Vec3d Surface::to_polar(Vec3d v) const { return product(grading_.frame().transpose(), v); }
Vec3d Surface::from_polar(Vec3d v) const { return product(grading_.frame(), v); }

}  // namespace asterflow
