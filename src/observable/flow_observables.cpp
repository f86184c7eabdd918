#include "observable/flow_observables.hpp"

#include "fiber/fibers.hpp"
#include "io/frame.hpp"
#include "mechanism/cytoplasmic_pulling.hpp"
#include "observable/fluid_samples.hpp"
#include "observable/force_moments.hpp"
#include "system/no_slip.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

constexpr char const* axes = "xyz";

// Tangents [n_node] of all fibers.
PointArray tangents_of(StoredFibers const& fibers) {
  PointArray tangents(fibers.position.size()), curvatures(fibers.position.size());
  for (std::size_t i = 0; i < fibers.count(); ++i)
    differentiate(fibers, i, Points(tangents).subspan(fibers.first[i], fibers.node_count(i)),
                  Points(curvatures).subspan(fibers.first[i], fibers.node_count(i)));
  return tangents;
}

// Material velocities [n_node] of the fibers in the flow u of all others: V = u + c (I + t t) (f - f_dipole + f_motor).
PointArray material_velocities(ConstPoints u, Scene const& scene, StoredFibers const& fibers, ConstPoints tangents) {
  double const viscosity = scene.fluid.viscosity, offset = scene.cytoplasmic_pulling ? scene.cytoplasmic_pulling->cargo_offset : 0.0;
  PointArray velocity(u.begin(), u.end()), dipoles(u.size());
  for (std::size_t i = 0; i < fibers.count(); ++i) {
    double const c = slender_body_mobility(fibers.length[i], fibers.material[i].radius, viscosity);
    auto const n = static_cast<std::size_t>(fibers.node_count(i));
    if (offset > 0.0)
      add_tether_tension(fibers.motor_load[i] * offset, fibers.length[i], tangents.subspan(fibers.first[i], n),
                         Points(dipoles).subspan(fibers.first[i], n));
    for (auto k = fibers.first[i]; k < fibers.first[i + 1]; ++k) {
      Vec3d const force = fibers.force_density[k] - dipoles[k] + fibers.motor_load[i] * tangents[k];
      velocity[k] += c * (force + dot(tangents[k], force) * tangents[k]);
    }
  }
  return velocity;
}

struct Load {
  Vec3d force{}, torque{};  // pN; pN um about the origin
  void add(Vec3d x, Vec3d f, Vec3d couple = {}) {
    force += f;
    torque += cross(x, f) + couple;
  }
};

// From outside on bodies, about their centres; of held ones NaN in states stored before their loads were.
std::vector<Load> applied_to_bodies(Scene const& scene, Frame const& frame) {
  PointArray const forces = points_of(frame, "body/applied_force"), torques = points_of(frame, "body/applied_torque");
  std::vector<Load> loads;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    BodySpec const& body = scene.bodies[b];
    bool const is_free = body.motion == BodySpec::Motion::free;
    Vec3d const unknown = std::nan("") * Vec3d{1.0, 1.0, 1.0};
    if (b < forces.size() && b < torques.size()) loads.push_back({forces[b], torques[b]});
    else if (is_free) loads.push_back({body.force, body.torque});
    else loads.push_back({unknown, unknown});
  }
  return loads;
}

void add_power(StoredFlow const& flow, std::span<Load const> applied, StoredFibers const& fibers, ConstPoints velocity,
               ConstPoints tangents, Observables& row) {
  double motors = 0.0, tips = 0.0, bodies = 0.0;
  for (std::size_t i = 0; i < fibers.count(); ++i) {
    for (auto k = fibers.first[i]; k < fibers.first[i + 1]; ++k)
      motors += fibers.weight[k] * fibers.motor_load[i] * dot(tangents[k], velocity[k]);
    if (norm(fibers.plus_end_force[i]) > 0.0)
      tips += dot(fibers.plus_end_force[i],
                  value_at_end(velocity.subspan(fibers.first[i], fibers.node_count(i)), 1.0));
  }
  for (std::size_t b = 0; b < applied.size(); ++b)
    bodies += flow.motions()[b].head<3>().dot(to_eigen(applied[b].force)) + flow.motions()[b].tail<3>().dot(to_eigen(applied[b].torque));
  row.push_back({"motor_power", motors});
  row.push_back({"tip_power", tips});
  row.push_back({"body_power", bodies});
}

void add_fibers(StoredFlow const& flow, Scene const& scene, Frame const& frame, StoredFibers const& fibers, Observables& row) {
  PointArray const u = flow.incident_at_fibers(), tangents = tangents_of(fibers);
  add_power(flow, applied_to_bodies(scene, frame), fibers, material_velocities(u, scene, fibers, tangents), tangents, row);
}

void add_applied_to_fiber(StoredFibers const& fibers, std::size_t i, ConstPoints nodes, Load& sum) {
  Vec3d const minus_end = value_at_end(nodes, 0.0);
  sum.add(value_at_end(nodes, 1.0), fibers.plus_end_force[i]);
  sum.add(minus_end, fibers.contact_force[i], fibers.contact_torque[i]);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    sum.add(nodes[k], fibers.weight[static_cast<std::size_t>(fibers.first[i]) + k] * fibers.external_load[i]);
  MinusEnd const kind = fibers.material[i].minus_end;
  if (fibers.body[i] >= 0 || kind == MinusEnd::free) return;
  // What holds it in space gives this back; a hinge no torque.
  sum.add(minus_end, -fibers.minus_end_force[i], kind == MinusEnd::clamped ? -fibers.minus_end_torque[i] : Vec3d{});
}

// From outside on plus ends, along fibers and on bodies.
Load applied_load(StoredFlow const& flow, Scene const& scene, Frame const& frame, StoredFibers const& fibers) {
  Load sum;
  ConstPoints const nodes = flow.radiation().nodes();
  for (std::size_t i = 0; i < fibers.count(); ++i)
    add_applied_to_fiber(fibers, i, nodes.subspan(fibers.first[i], fibers.node_count(i)), sum);
  PointArray contact_forces = points_of(frame, "body/contact_force"), contact_torques = points_of(frame, "body/contact_torque");
  contact_forces.resize(scene.bodies.size());
  contact_torques.resize(scene.bodies.size());
  std::vector<Load> const applied = applied_to_bodies(scene, frame);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    sum.add(flow.radiation().body_pose(b).position, applied[b].force + contact_forces[b], applied[b].torque + contact_torques[b]);
  return sum;
}

void add_moments(StoredFlow const& flow, Scene const& scene, SceneFlows const& flows, Frame const& frame,
                 StoredFibers const& fibers, Observables& row) {
  Vec3d const centre = scene.bodies.empty() ? Vec3d{} : flow.radiation().body_pose(0).position;
  ForceMoments const sum = force_moments(flow, flows, scene.fluid.viscosity, fibers, centre);
  for (int k = 0; k < 3; ++k) row.push_back({std::string("net_force_") + axes[k], sum.force[k]});
  for (int k = 0; k < 3; ++k) row.push_back({std::string("net_torque_") + axes[k], sum.torque[k]});
  Load const applied = applied_load(flow, scene, frame, fibers);
  row.push_back({"force_imbalance", norm(sum.force - applied.force)});
  row.push_back({"torque_imbalance", norm(sum.torque - applied.torque)});
  for (auto const& [i, j] : {std::pair{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}})
    row.push_back({std::string("force_moment_") + axes[i] + axes[j], sum.moment(i, j)});
  row.push_back({"puller_index", sum.absolute > 0.0 ? -1.5 * sum.moment(0, 0) / sum.absolute : std::nan("")});
}

PointArray velocity_at(StoredFlow const& flow, ConstPoints points) {
  PointArray velocity(points.size());
  if (!points.empty()) flow.velocity(points, velocity);
  return velocity;
}

double mean_x(ConstPoints velocity) {
  double sum = 0.0;
  for (Vec3d const& u : velocity) sum += u.x;
  return velocity.empty() ? std::nan("") : sum / static_cast<double>(velocity.size());
}

// Along the fibers, and along x on the -x side of the first body.
void add_flow_in_asters(StoredFlow const& flow, FluidSamples const& samples, Observables& row) {
  PointArray const velocity = velocity_at(flow, samples.beside_fibers);
  double const border = flow.motions().empty() ? 0.0 : flow.radiation().body_pose(0).position.x;
  double along = 0.0;
  PointArray anterior;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    along += dot(velocity[i], samples.fiber_directions[i]);
    if (samples.beside_fibers[i].x < border) anterior.push_back(velocity[i]);
  }
  row.push_back({"flow_along_fibers", velocity.empty() ? std::nan("") : along / static_cast<double>(velocity.size())});
  row.push_back({"flow_in_anterior_asters_x", mean_x(anterior)});
}

void add_speeds(StoredFlow const& flow, Scene const& scene, Frame const& frame, StoredFibers const& fibers,
                Observables& row) {
  FluidSamples const samples = fluid_samples(scene, frame, fibers);
  double sum = 0.0, largest = 0.0;
  for (Vec3d const& u : velocity_at(flow, samples.spread)) sum += norm(u), largest = std::max(largest, norm(u));
  double const mean = sum / static_cast<double>(samples.spread.size());
  double const body = scene.bodies.empty() ? std::nan("") : flow.motions()[0].head<3>().norm();
  row.push_back({"fluid_speed_mean", mean});
  row.push_back({"fluid_speed_largest", largest});
  row.push_back({"fluid_speed_ratio", body > 0.0 ? mean / body : std::nan("")});
  row.push_back({"flow_anterior_x", mean_x(velocity_at(flow, samples.anterior))});
  row.push_back({"flow_posterior_x", mean_x(velocity_at(flow, samples.posterior))});
  add_flow_in_asters(flow, samples, row);
  bool const has_surface = flow.radiation().nodes().size() > flow.radiation().n_fiber_nodes();
  row.push_back({"no_slip_residual", has_surface ? no_slip_residual(flow).relative() : std::nan("")});
}

Observables nothing() {
  Observables row;
  for (char const* name :
       {"motor_power", "tip_power", "body_power", "net_force_x", "net_force_y", "net_force_z", "net_torque_x",
        "net_torque_y", "net_torque_z", "force_imbalance", "torque_imbalance", "force_moment_xx", "force_moment_yy", "force_moment_zz",
        "force_moment_xy", "force_moment_xz", "force_moment_yz", "puller_index", "fluid_speed_mean",
        "fluid_speed_largest", "fluid_speed_ratio", "flow_anterior_x", "flow_posterior_x", "flow_along_fibers",
        "flow_in_anterior_asters_x", "no_slip_residual"})
    row.push_back({name, std::nan("")});
  return row;
}

}  // namespace

Observables flow_observables(Scene const& scene, SceneFlows const& flows, Frame const& frame,
                             StoredFibers const& fibers) {
  if (scene.run.interactions == Interactions::local || frame.time == 0.0) return nothing();
  StoredFlow const flow(scene, flows, frame);
  Observables row;
  add_fibers(flow, scene, frame, fibers, row);
  add_moments(flow, scene, flows, frame, fibers, row);
  add_speeds(flow, scene, frame, fibers, row);
  return row;
}

}  // namespace asterflow
