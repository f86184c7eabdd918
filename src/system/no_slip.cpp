#include "system/no_slip.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

constexpr int highest_count = 20;  // of rings, and of points on half a ring

// Middles of the cells between the nodes, in the frame of the shape.
PointArray points_between_nodes(Surface const& surface) {
  SphereGrid const& grid = surface.grid();
  auto const& t = grid.polar_angles();
  int const ring_stride = (grid.n_ring() + highest_count - 1) / highest_count;
  int const azimuth_stride = (grid.n_azimuth() + 2 * highest_count - 1) / (2 * highest_count);
  PointArray points;
  for (int j = 0; j + 1 < grid.n_ring(); j += ring_stride)
    for (int k = 0; k < grid.n_azimuth(); k += azimuth_stride)
      points.push_back(surface.patch(0.5 * (t[j] + t[j + 1]), grid.azimuth(k) + 0.5 * grid.azimuth(1)).position);
  return points;
}

double largest(ConstPoints velocities) {
  double square = 0.0;
  for (Vec3d const u : velocities) square = std::max(square, dot(u, u));
  return std::sqrt(square);
}

}  // namespace

double NoSlipResidual::relative() const { return is_at_rest() ? 0.0 : std::max(periphery, bodies) / speed; }

NoSlipResidual no_slip_residual(StoredFlow const& flow) {
  Radiation const& radiation = flow.radiation();
  NoSlipResidual residual;
  residual.speed = largest(flow.surface_incident());
  PointArray points, slip;
  for (std::size_t b = 0; b < flow.motions().size(); ++b) {
    RigidPose const& pose = radiation.body_pose(b);
    points = points_between_nodes(radiation.body_surface(b));
    for (Vec3d& x : points) x = pose.point(x);
    slip.resize(points.size());
    flow.velocity(points, slip);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3d const wall = velocity_of_motion(flow.motions()[b], points[i] - pose.position);
      residual.speed = std::max(residual.speed, norm(wall));
      slip[i] -= wall;
    }
    residual.bodies = std::max(residual.bodies, largest(slip));
  }
  if (radiation.has_periphery()) {
    points = points_between_nodes(radiation.periphery_surface());
    slip.resize(points.size());
    flow.velocity(points, slip);
    residual.periphery = largest(slip);
  }
  return residual;
}

}  // namespace asterflow
