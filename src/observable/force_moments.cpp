#include "observable/force_moments.hpp"

#include "surface/sphere_grid.hpp"

#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

Matrix3 moment_of(Vec3d r, Vec3d f) {
  Matrix3 const dyad = to_eigen(r) * to_eigen(f).transpose();
  return 0.5 * (dyad + dyad.transpose()) - dot(r, f) / 3.0 * Matrix3::Identity();
}

// A body's own flow on a sphere around it, in the frame of the body.
Matrix3 moment_of_flow(DirichletFlow const& flow, ConstPoints wall_velocity, double viscosity) {
  double const radius = 2.0 * flow.surface().shape().size();
  SphereGrid const grid(8);  // the flow there has decayed to its first few moments
  PointArray normals, points;
  for (double const theta : grid.polar_angles())
    for (int k = 0; k < grid.n_azimuth(); ++k) {
      double const phi = grid.azimuth(k);
      normals.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
      points.push_back(radius * normals.back());
    }
  PointArray velocity(points.size());
  flow.add_velocity(wall_velocity, flow.plan(points), velocity);
  Matrix3 moment = Matrix3::Zero();
  double const ring = 2.0 * std::numbers::pi / grid.n_azimuth() * radius * radius;
  for (std::size_t i = 0; i < points.size(); ++i)
    moment += grid.ring_weights()[i / grid.n_azimuth()] * ring * moment_of(normals[i], velocity[i]);
  return 5.0 * viscosity * moment;
}

// What a body's surface does to the fluid beside what meets it, in the frame of the body.
PointArray wall_velocity(StoredFlow const& flow, std::size_t body) {
  Radiation const& radiation = flow.radiation();
  RigidPose const& pose = radiation.body_pose(body);
  Matrix3 const back = pose.rotation.transpose();
  std::size_t const first = radiation.first_body_node(body), n = radiation.body_surface(body).size();
  ConstPoints const incident = flow.surface_incident().subspan(first - radiation.n_fiber_nodes(), n);
  PointArray wall(n);
  for (std::size_t i = 0; i < n; ++i)
    wall[i] = back * (velocity_of_motion(flow.motions()[body], radiation.nodes()[first + i] - pose.position) - incident[i]);
  return wall;
}

void add_body(DirichletFlow const& own, ConstPoints wall, RigidPose const& pose, double viscosity, Vec3d centre,
              ForceMoments& sum) {
  Vector6 const load = viscosity * own.load(wall);
  Vec3d const force = pose.rotation * to_vec3(load.head<3>()), torque = pose.rotation * to_vec3(load.tail<3>());
  Matrix3 const moment = pose.rotation * moment_of_flow(own, wall, viscosity) * pose.rotation.transpose();
  sum.add(pose.position, force, centre);
  sum.torque += torque;
  sum.moment += moment;
  sum.absolute += std::sqrt(1.5) * moment.norm();
}

}  // namespace

void ForceMoments::add(Vec3d x, Vec3d f, Vec3d centre) {
  force += f;
  torque += cross(x, f);
  moment += moment_of(x - centre, f);
  absolute += norm(x - centre) * norm(f);
}

ForceMoments force_moments(StoredFlow const& flow, SceneFlows const& flows, double viscosity, StoredFibers const& fibers,
                           Vec3d centre) {
  ForceMoments sum;
  for (std::size_t i = 0; i < fibers.position.size(); ++i)
    sum.add(flow.radiation().nodes()[i], fibers.weight[i] * fibers.force_density[i], centre);
  for (std::size_t b = 0; b < flows.bodies.size(); ++b)
    add_body(*flows.bodies[b], wall_velocity(flow, b), flow.radiation().body_pose(b), viscosity, centre, sum);
  return sum;
}

}  // namespace asterflow
