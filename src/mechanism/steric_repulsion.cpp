#include "mechanism/steric_repulsion.hpp"

#include "base/parallel.hpp"
#include "mechanism/fiber_contacts.hpp"
#include "surface/contact.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace asterflow {

namespace {

constexpr int most_passes = 20;

// Whether there is a fiber and a body that does not hold it.
bool meets_others(Fibers& fibers, std::size_t n_body) {
  if (n_body != 1) return n_body > 1 && fibers.count() > 0;
  for (std::size_t i = 0; i < fibers.count(); ++i)
    if (!fibers.plan(i).site.is_attached()) return true;
  return false;
}

}  // namespace

StericRepulsion::StericRepulsion(StericRepulsionSpec const& spec, std::shared_ptr<Shape const> cortex,
                                 std::vector<std::shared_ptr<Shape const>> bodies)
    : spec_(spec), cortex_(std::move(cortex)), bodies_(std::move(bodies)) {}

// For those motions of the bodies.
StericRepulsion::FiberLoads StericRepulsion::hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies,
                                                  std::span<Vector6 const> motions, std::span<TipLoad const> free_tips) const {
  FiberSurroundings const around{spec_, cortex_.get(), bodies_, bodies, motions};
  std::vector<std::vector<BodyReaction>> reactions(fibers.count());
  parallel_for("StericRepulsion::hold", static_cast<long>(fibers.count()), [&](long i) {
    reactions[i] = FiberContacts(around, fibers, static_cast<std::size_t>(i)).hold(u, free_tips[i]);
  });
  FiberLoads contacts{.loads = std::vector<ContactLoad>(bodies_.size())};
  for (auto const& of_fiber : reactions)
    for (BodyReaction const& reaction : of_fiber) {
      contacts.loads[reaction.body].load += reaction.load;
      contacts.loads[reaction.body].resistance += reaction.resistance;
      contacts.any = true;
    }
  return contacts;
}

// Broyden's method for the motions q of all bodies: residual = K (q - local motion) - load by fibers. The first matrix takes
// fibers for rigid.
std::vector<Vector6> StericRepulsion::hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies,
                                           std::function<LocalMotions()> const& local_motions) const {
  std::size_t const n = bodies.size();
  std::vector<Vector6> motions, loads(n, Vector6::Zero());
  if (!(cortex_ && spec_.fiber_cortex) && !spec_.fiber_body) return loads;
  for (auto const& map : bodies) motions.push_back(map.predicted_motion());
  std::vector<TipLoad> free_tips;
  for (std::size_t i = 0; i < fibers.count(); ++i) free_tips.push_back(fibers.plan(i).tip);

  bool const can_touch = spec_.fiber_body && meets_others(fibers, n);
  bool had_contact = false;
  Eigen::Index const size = static_cast<Eigen::Index>(6 * n);
  Eigen::VectorXd residual(size), before(size), change = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(size, size);
  for (int pass = 0; pass < most_passes; ++pass) {
    FiberLoads const contacts = hold(fibers, u, bodies, motions, free_tips);
    for (std::size_t b = 0; b < n; ++b) loads[b] = contacts.loads[b].load;
    if (!can_touch) return loads;
    LocalMotions const local = local_motions();
    before = residual;
    for (std::size_t b = 0; b < n; ++b) {
      Eigen::Index const row = static_cast<Eigen::Index>(6 * b);
      bool const is_free = !local.resistances[b].isZero(0.0);
      residual.segment<6>(row) =
          is_free ? Vector6(local.resistances[b] * (motions[b] - local.motions[b]) - loads[b]) : Vector6(Vector6::Zero());
      if (!had_contact && is_free) jacobian.block<6, 6>(row, row) = local.resistances[b] + contacts.loads[b].resistance;
    }
    if (had_contact) jacobian += (residual - before - jacobian * change) / change.squaredNorm() * change.transpose();
    had_contact = contacts.any;
    change = -jacobian.partialPivLu().solve(residual);
    double moved = 0.0;
    for (std::size_t b = 0; b < n; ++b) {
      Vector6 const correction = change.segment<6>(static_cast<Eigen::Index>(6 * b));
      moved = std::max(moved, bodies[b].displacement_per_velocity * correction.head<3>().norm() +
                                  bodies_[b]->size() * (bodies[b].turn_per_angular_velocity * correction.tail<3>()).norm());
      motions[b] += correction;
    }
    if (moved < 1e-5 * spec_.range) break;
  }
  return loads;
}

Vector6 BodyContacts::load(std::size_t body, std::span<Vector6 const> motions) const {
  Vector6 load = loads[body].load - loads[body].resistance * motions[body];
  if (between.size() == 0) return load;
  for (std::size_t c = 0; c < motions.size(); ++c)
    load -= between.block<6, 6>(static_cast<Eigen::Index>(6 * body), static_cast<Eigen::Index>(6 * c)) * motions[c];
  return load;
}

BodyContacts StericRepulsion::on_bodies(std::span<BodyMotionMap const> maps) const {
  BodyContacts contacts;
  contacts.loads.resize(maps.size());
  for (std::size_t b = 0; b < maps.size(); ++b) {
    if (cortex_ && spec_.body_cortex) add_cortex(b, maps[b], contacts.loads[b]);
    if (!spec_.body_body) continue;
    for (std::size_t c = 0; c < b; ++c) add_pair(c, b, maps, contacts);
  }
  return contacts;
}

void StericRepulsion::add_cortex(std::size_t body, BodyMotionMap const& map, ContactLoad& load) const {
  PlacedSurface const placed{bodies_[body], map.predicted.position, Eigen::Quaterniond(map.predicted.rotation)};
  Contact const contact = find_contact(placed, {.shape = cortex_, .encloses = true});
  if (!(contact.gap < spec_.range)) return;
  Vec3d const arm = contact.first - map.predicted.position;
  Eigen::Vector3d const away = -to_eigen(cortex_->closest_point(contact.first).normal);
  Matrix6 const resistance = map.spring_resistance(arm, spec_.body_force / spec_.range * away * away.transpose());
  Vec3d const force = spec_.body_force * (1 - contact.gap / spec_.range) * to_vec3(away);
  load.resistance += resistance;
  load.load += load_of_force(force, arm) + resistance * map.predicted_motion();
}

// The gap is linear in the motions of both; the force acts halfway between them, on both, so that torques balance too.
void StericRepulsion::add_pair(std::size_t one, std::size_t other, std::span<BodyMotionMap const> maps,
                               BodyContacts& contacts) const {
  auto const placed = [&](std::size_t b) {
    RigidPose const& pose = maps[b].predicted;
    return PlacedSurface{bodies_[b], pose.position, Eigen::Quaterniond(pose.rotation)};
  };
  auto const centre = [&](std::size_t b) { return maps[b].predicted.point(bodies_[b]->centre()); };
  if (norm(centre(one) - centre(other)) > bodies_[one]->size() + bodies_[other]->size() + spec_.range) return;
  PlacedSurface const first = placed(one);
  Contact const contact = find_contact(first, placed(other));
  if (!(contact.gap < spec_.range)) return;
  Vec3d const place = 0.5 * (contact.first + contact.second);
  Vec3d const n = first.turn_to_laboratory(bodies_[one]->closest_point(first.to_shape(place)).normal);
  std::size_t const bodies[] = {one, other};
  Vector6 unit_loads[2], openings[2];  // of a unit force along n; change of the gap with the motions
  double gap_at_rest = contact.gap;    // of bodies that stay where motion zero leaves them
  for (int i : {0, 1}) {
    BodyMotionMap const& map = maps[bodies[i]];
    Vec3d const arm = place - map.predicted.position, away = i == 0 ? -n : n;
    unit_loads[i] = load_of_force(away, arm);
    openings[i] = map.displacement_of(arm).transpose() * to_eigen(away);
    gap_at_rest -= openings[i].dot(map.predicted_motion());
  }
  double const stiffness = spec_.body_force / spec_.range;
  Eigen::Index const size = static_cast<Eigen::Index>(6 * maps.size());
  if (contacts.between.size() == 0) contacts.between = Eigen::MatrixXd::Zero(size, size);
  for (int i : {0, 1}) {
    ContactLoad& load = contacts.loads[bodies[i]];
    load.load += stiffness * (spec_.range - gap_at_rest) * unit_loads[i];
    load.resistance += stiffness * unit_loads[i] * openings[i].transpose();
    contacts.between.block<6, 6>(static_cast<Eigen::Index>(6 * bodies[i]), static_cast<Eigen::Index>(6 * bodies[1 - i])) +=
        stiffness * unit_loads[i] * openings[1 - i].transpose();
  }
}

}  // namespace asterflow
