#include "surface/modal_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace asterflow;

namespace {

Surface spheroid(double a, double b, int order) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {a, b, b}};
  return Surface(make_shape(spec), order);
}

// Sum of row i of a mode over the columns of a component.
double component_sum(ModalRowSet const& rows, int m, int out, int in) {
  auto const n = rows[m].cols() / 3;
  return rows[m].row(out).segment(in * n, n).sum();
}

}  // namespace

TEST(ModalRows, agree_with_plain_quadrature_far_away) {
  Surface const surface = spheroid(2.0, 1.0, 30);
  CylindricalPoint const target{3.0, 3.0};
  ModalRowSet const rows = ModalRows(surface, 12.0).at(target);
  int const m = 2, n = surface.grid().n_ring();
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  Vec3d plain{};
  for (int j = 0; j < n; ++j) {
    double const theta = surface.grid().polar_angles()[j], amplitude = std::sin(theta) * std::sin(theta);
    u += rows[m].col(j) * amplitude;
    for (int k = 0; k < surface.grid().n_azimuth(); ++k) {
      auto const i = static_cast<std::size_t>(j) * surface.grid().n_azimuth() + k;
      Vec3d const r = Vec3d{target.z, target.r, 0.0} - surface.nodes()[i];
      double const q = amplitude * std::cos(m * surface.grid().azimuth(k));
      plain += -3.0 / (4.0 * std::numbers::pi) * surface.weights()[i] * q * r.x * dot(r, surface.normals()[i]) / std::pow(norm(r), 5) * r;
    }
  }
  EXPECT_NEAR(u[0], plain.x, 1e-11);
  EXPECT_NEAR(u[1], plain.y, 1e-11);
}

TEST(ModalRows, constant_density_gives_one_inside_half_on_and_zero_outside) {
  Surface const surface = spheroid(25.0, 15.0, 12);
  ModalRows const rows(surface, 11.0);
  EXPECT_NEAR(component_sum(rows.at({3.0, 2.0}), 0, 0, 0), 1.0, 1e-13);
  EXPECT_NEAR(component_sum(rows.at({24.999, 0.0}), 0, 0, 0), 1.0, 1e-13);
  EXPECT_NEAR(component_sum(rows.on_surface(0.7), 0, 0, 0), 0.5, 1e-13);
  EXPECT_NEAR(component_sum(rows.at({25.001, 0.0}), 0, 0, 0), 0.0, 1e-13);
}
