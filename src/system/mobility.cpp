#include "system/mobility.hpp"

#include "base/error.hpp"
#include "surface/resistance.hpp"
#include "system/flows.hpp"
#include "system/population.hpp"
#include "system/rigid_fibers.hpp"

#include <Eigen/LU>
#include <fmt/format.h>

namespace asterflow {
namespace {

// Loads that the bodies exert on the fluid and their fibers when they move with `motions`.
Eigen::VectorXd loads_of(RigidFibers const& fibers, Radiation* radiation, std::vector<BodyDrive> const& bodies,
                         ScatteringSolution const& solution) {
  Eigen::VectorXd result(6 * bodies.size());
  std::size_t const n = fibers.nodes().positions.size();
  std::vector<Vector6> from_fibers(bodies.size(), Vector6::Zero());
  PointArray force_density(n);
  fibers.add_linear_response(ConstPoints(solution.incident).first(n), solution.motions, force_density, from_fibers);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Vector6 load = bodies[b].resistance * solution.motions[b] - from_fibers[b];
    if (radiation) load -= radiation->load_of_incident(b, solution.incident);
    result.segment<6>(6 * static_cast<Eigen::Index>(b)) = load;
  }
  return result;
}

// Bodies alone: boundary integrals whose nodes crowd where surfaces are close, accurate down to small gaps.
SceneMobility mobility_of_bodies(Scene const& scene) {
  SceneMobility result;
  std::vector<PlacedSurface> bodies;
  int order = 0;
  for (auto const& body : scene.bodies) {
    bodies.push_back({make_shape(body.shape), body.position, body.orientation});
    result.names.push_back(body.name);
    order = std::max(order, body.order);
  }
  std::optional<PlacedSurface> periphery;
  if (scene.run.interactions == Interactions::confined) {
    periphery = {make_shape(scene.periphery->shape), {}, Eigen::Quaterniond::Identity(), true};
    order = std::max(order, scene.periphery->order);
  }
  auto solved = solve_resistance(bodies, periphery, {scene.fluid.viscosity, scene.run.accuracy, order});
  result.resistance = std::move(solved.resistance);
  result.mobility = std::move(solved.mobility);
  result.error = solved.error;
  return result;
}

}  // namespace

SceneMobility scene_mobility(Scene const& scene) {
  SceneMobility result;
  std::size_t const n = scene.bodies.size();
  Fibers fibers(scene.fluid.viscosity);
  std::optional<PlusEnds> no_growth;
  add_scene_fibers(scene, fibers, no_growth);
  if (n > 0 && fibers.count() == 0 && scene.run.interactions != Interactions::local) return mobility_of_bodies(scene);
  SceneFlows const flows = make_flows(scene);
  auto const exchange = make_radiation(scene, flows);
  std::vector<BodyDrive> bodies;
  std::vector<RigidPose> poses;
  for (std::size_t b = 0; b < n; ++b) {
    result.names.push_back(scene.bodies[b].name);
    poses.push_back({scene.bodies[b].position, scene.bodies[b].orientation.toRotationMatrix()});
    bodies.push_back({poses[b], body_resistance(*flows.bodies[b], poses[b], scene.fluid.viscosity), false});
  }
  RigidFibers const rigid(fibers, scene.fluid.viscosity, poses);
  Recycling memory(recycled_directions);
  Scattering scattering(rigid, bodies, exchange.get(), &memory,
                        {.tolerance = scene.run.gmres_tolerance, .max_iterations = scene.run.gmres_max_iterations});
  result.resistance.resize(6 * n, 6 * n);
  for (Eigen::Index column = 0; column < result.resistance.cols(); ++column) {
    for (std::size_t b = 0; b < n; ++b) scattering.set_drive(b, Vector6::Zero());
    scattering.set_drive(column / 6, Vector6::Unit(column % 6));
    auto const solution = scattering.solve({}, {});
    if (!solution.gmres.converged)
      throw NumericalError(fmt::format("mobility: GMRES stopped after {} iterations at residual {:.3g}",
                                       solution.gmres.iterations, solution.gmres.residual));
    result.resistance.col(column) = loads_of(rigid, exchange.get(), bodies, solution);
  }
  result.mobility = result.resistance.inverse();
  return result;
}

}  // namespace asterflow
