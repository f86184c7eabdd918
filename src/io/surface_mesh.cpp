#include "io/surface_mesh.hpp"

#include "surface/shapes.hpp"

#include <numbers>

namespace asterflow {

void add_surface(ShapeSpec const& spec, Vec3d position, Eigen::Quaterniond const& orientation, int n_theta,
                 PolyMesh& mesh) {
  auto const shape = make_shape(spec);
  Eigen::Matrix3d const rotation = orientation.toRotationMatrix();
  auto const add_point = [&](double theta, double phi) {
    Vec3d const x = shape->point(theta, phi);
    Eigen::Vector3d const turned = rotation * Eigen::Vector3d(x.x, x.y, x.z);
    mesh.points.push_back(position + Vec3d{turned.x(), turned.y(), turned.z()});
  };
  int const n_phi = 2 * n_theta;
  auto const north = static_cast<std::int64_t>(mesh.points.size()), south = north + 1, rings = north + 2;
  add_point(0.0, 0.0);
  add_point(std::numbers::pi, 0.0);
  for (int i = 0; i < n_theta; ++i)
    for (int j = 0; j < n_phi; ++j)
      add_point(std::numbers::pi * (i + 1) / (n_theta + 1), 2.0 * std::numbers::pi * j / n_phi);

  for (int j = 0; j < n_phi; ++j) {
    int const k = (j + 1) % n_phi;
    mesh.triangles.push_back({north, rings + j, rings + k});
    for (int i = 0; i + 1 < n_theta; ++i) {
      auto const upper = rings + i * n_phi, lower = upper + n_phi;
      mesh.triangles.push_back({upper + j, lower + j, lower + k});
      mesh.triangles.push_back({upper + j, lower + k, upper + k});
    }
    auto const last = rings + (n_theta - 1) * n_phi;
    mesh.triangles.push_back({last + j, south, last + k});
  }
}

}  // namespace asterflow
