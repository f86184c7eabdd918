#include "fiber/fibers.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {

double slender_body_mobility(double length, double radius, double viscosity) {
  double const eps = std::min(radius / length, 0.25);
  return (-2 * std::log(eps) - 1) / (8 * std::numbers::pi * viscosity);
}

namespace {

// One fiber may err by so many times the error of all, which is the root of the mean square.
constexpr double tolerated_outlier = 10.0;

// Turns every tangent by the least rotation that takes the first one to `direction`.
void align(Centreline& shape, Vec3d direction) {
  Matrix3 const turn =
      Eigen::Quaterniond::FromTwoVectors(to_eigen(shape.tangents[0]), to_eigen(direction)).toRotationMatrix();
  for (Vec3d& t : shape.tangents) t = normalized(turn * t);
  shape.tangents[0] = direction;
}

}  // namespace

Fibers::Fibers(double viscosity) : viscosity_(viscosity) { ASTERFLOW_REQUIRE(viscosity > 0); }

std::size_t Fibers::add(FiberProperties const& properties, MinusEndSite const& site, Centreline const& shape) {
  FiberBasis const& basis = fiber_basis(properties.n_node);
  ASTERFLOW_REQUIRE(static_cast<int>(shape.tangents.size()) == basis.n_tangent);
  ASTERFLOW_REQUIRE(shape.length > 0 && properties.bending_rigidity > 0 && properties.radius > 0);
  Fiber& fiber = fibers_.emplace_back();
  fiber.properties = properties;
  fiber.site = site;
  fiber.past[0] = fiber.past[1] = fiber.past[2] = fiber.predicted = fiber.trial = fiber.newborn = shape;
  fiber.tension.assign(properties.n_node, 0.0);
  fiber.trial_tension = fiber.tension;
  has_nonlocal_ |= properties.is_nonlocal;
  lay_out();
  return fibers_.size() - 1;
}

void Fibers::lay_out() {
  first_node_.assign(1, 0);
  for (Fiber const& fiber : fibers_) first_node_.push_back(first_node_.back() + fiber.properties.n_node);
  nodes_.resize(first_node_.back());
  weights_.resize(first_node_.back());
  fiber_loads_.resize(fibers_.size());
}

void Fibers::begin_step() {
  for (Fiber& fiber : fibers_)
    fiber.plan = {fiber.past[0].length, fiber.properties.load, fiber.properties.tip, fiber.site};
}

TimeScheme Fibers::scheme_of(Fiber const& fiber) const {
  return usable_past(fiber) < 2 ? backward_euler(dt_) : second_order_scheme(dt_, dt_1_);
}

// Accepted states whose motion goes on in this step.
int Fibers::usable_past(Fiber const& fiber) const {
  return fiber.plan.is_newborn ? 1 : fiber.n_past;
}

bool Fibers::has_jumped(Fiber const& fiber) { return norm(fiber.plan.tip_jump) > 0 || fiber.n_smooth < 3; }

bool Fibers::has_jumped(int body) const {
  return std::any_of(fibers_.begin(), fibers_.end(),
                     [&](Fiber const& fiber) { return fiber.site.is_attached() && fiber.site.body == body && has_jumped(fiber); });
}

// The shape at the end of the step, linearly extrapolated at fixed material coordinates and put on its site.
void Fibers::predict(Fiber& fiber, std::span<BodyMotionMap const> bodies) const {
  MinusEndSite const& site = fiber.plan.site;
  RigidPose const now = site.is_attached() ? bodies[site.body].now : RigidPose{};
  RigidPose const then = site.is_attached() ? bodies[site.body].predicted : RigidPose{};
  if (fiber.plan.is_newborn)
    fiber.newborn = straight_centreline(now.point(site.position), now.rotation * site.direction, fiber.plan.length,
                                        fiber.properties.n_node);
  FiberBasis const& basis = fiber_basis(fiber.properties.n_node);
  Centreline const& latest = fiber.plan.is_newborn ? fiber.newborn : fiber.past[0];
  Centreline& shape = fiber.predicted;
  shape.length = fiber.plan.length;
  shape.minus_end = latest.minus_end;
  shape.tangents.resize(basis.n_tangent);
  fiber.coordinates.resize(basis.n_tangent);
  fiber.sampled.resize(basis.n_tangent);
  Eigen::Map<Eigen::VectorXd>(fiber.coordinates.data(), basis.n_tangent) = shape.length * basis.lobatto.nodes;
  sample(latest, fiber.coordinates, {}, shape.tangents);
  if (usable_past(fiber) > 1) {
    double const w = dt_ / dt_1_;
    sample(fiber.past[1], fiber.coordinates, {}, fiber.sampled);
    shape.minus_end += w * (latest.minus_end - fiber.past[1].minus_end);
    for (int j = 0; j < basis.n_tangent; ++j) {
      Vec3d const change = w * (shape.tangents[j] - fiber.sampled[j]);
      shape.tangents[j] += std::min(1.0, 0.5 / std::max(norm(change), 1e-300)) * change;  // at most half a radian
    }
  }
  for (Vec3d& t : shape.tangents) t = normalized(t);
  if (site.kind != MinusEnd::free) shape.minus_end = then.point(site.position);
  if (site.kind == MinusEnd::clamped) align(shape, normalized(then.rotation * site.direction));
}

void Fibers::set_history(Fiber& fiber, TimeScheme const& scheme) const {
  FiberBasis const& basis = fiber_basis(fiber.properties.n_node);
  int const n = basis.n_node;
  fiber.history.assign(n, Vec3d{});
  fiber.extrapolated.assign(n, Vec3d{});
  fiber.sampled.resize(n);
  fiber.coordinates.resize(n);
  Eigen::Map<Eigen::VectorXd>(fiber.coordinates.data(), n) = fiber.plan.length * basis.gauss.nodes;
  int const n_past = usable_past(fiber);
  double const a = dt_, b = dt_ + dt_1_, c = b + dt_2_;  // from the states to the end of the step
  double extrapolation[3] = {1.0, 0.0, 0.0};
  if (n_past == 2) extrapolation[0] = b / (b - a), extrapolation[1] = a / (a - b);
  if (n_past == 3) {
    extrapolation[0] = b * c / ((b - a) * (c - a));
    extrapolation[1] = a * c / ((a - b) * (c - b));
    extrapolation[2] = a * b / ((a - c) * (b - c));
  }
  double const share[3] = {scheme.a1, scheme.a2, 0.0};
  for (int past = 0; past < n_past; ++past) {
    sample(fiber.plan.is_newborn ? fiber.newborn : fiber.past[past], fiber.coordinates, fiber.sampled, {});
    for (int i = 0; i < n; ++i) {
      fiber.history[i] += share[past] * fiber.sampled[i];
      fiber.extrapolated[i] += extrapolation[past] * fiber.sampled[i];
    }
  }
}

void Fibers::prepare(double dt, std::span<BodyMotionMap const> bodies) {
  ASTERFLOW_REQUIRE(dt > 0);
  dt_ = dt;
  parallel_for("Fibers::prepare", static_cast<long>(count()),
               [&](long i) { prepare_again(static_cast<std::size_t>(i), bodies); });
}

void Fibers::prepare_again(std::size_t i, std::span<BodyMotionMap const> bodies) {
  Fiber& fiber = fibers_[i];
  FiberProperties const& own = fiber.properties;
  ASTERFLOW_REQUIRE(fiber.plan.length > 0);
  TimeScheme const scheme = scheme_of(fiber);
  predict(fiber, bodies);
  set_history(fiber, scheme);
  MinusEndSite const& site = fiber.plan.site;
  TipLoad tip = fiber.plan.tip;
  tip.force += late_share(scheme) * ((1 - fiber.plan.jump_at) * fiber.plan.tip_jump + fiber.late_force);
  FiberStep const step{.basis = &fiber_basis(own.n_node),
                       .scheme = scheme,
                       .bending_rigidity = own.bending_rigidity,
                       .mobility = slender_body_mobility(fiber.plan.length, own.radius, viscosity_),
                       .minus_end = site.kind,
                       .body = site.is_attached() ? &bodies[site.body] : nullptr,
                       .load = fiber.plan.load,
                       .tip = tip,
                       .node_loads = fiber.plan.node_loads,
                       .tension = fiber.plan.is_newborn ? ConstVector{} : ConstVector(fiber.tension)};
  std::size_t const first = first_node_[i], n = own.n_node;
  fiber.response.prepare(step, fiber.predicted, fiber.history, Points(nodes_).subspan(first, n),
                         Vector(weights_).subspan(first, n));
  if (own.is_nonlocal)
    fiber.own_flow.prepare(*step.basis, fiber.predicted, ConstPoints(nodes_).subspan(first, n), step.mobility, viscosity_);
}

void Fibers::node_answer(std::size_t i, ConstPoints u, Vector6 const& q, Points positions) const {
  Fiber const& fiber = fibers_[i];
  fiber.response.node_positions(u.subspan(first_node_[i], fiber.properties.n_node), q, positions);
}

TipAnswer Fibers::tip_answer(std::size_t i, ConstPoints u, Vector6 const& q) const {
  ASTERFLOW_REQUIRE(u.size() == node_count());
  Fiber const& fiber = fibers_[i];
  return fiber.response.tip_answer(u.subspan(first_node_[i], fiber.properties.n_node), q);
}

void Fibers::add_linear_response(ConstPoints u, std::span<Vector6 const> q, Points f, std::span<Vector6> loads) const {
  ASTERFLOW_REQUIRE(u.size() == node_count() && f.size() == node_count());
  parallel_for("Fibers::add_linear_response", static_cast<long>(count()), [&](long i) {
    Fiber const& fiber = fibers_[i];
    std::size_t const first = first_node_[i], n = fiber.properties.n_node;
    Vector6 const motion = fiber.plan.site.is_attached() ? q[fiber.plan.site.body] : Vector6::Zero();
    fiber_loads_[i].setZero();
    fiber.response.add_linear(u.subspan(first, n), motion, f.subspan(first, n),
                              loads.empty() ? nullptr : &fiber_loads_[i]);
  });
  if (!loads.empty()) add_to_bodies(loads);
}

void Fibers::add_loads(ConstPoints u, std::span<Vector6> loads) const {
  parallel_for("Fibers::add_loads", static_cast<long>(count()), [&](long i) {
    fiber_loads_[i].setZero();
    fibers_[i].response.add_load(u.subspan(first_node_[i], fibers_[i].properties.n_node), fiber_loads_[i]);
  });
  add_to_bodies(loads);
}

void Fibers::add_to_bodies(std::span<Vector6> loads) const {
  for (std::size_t i = 0; i < count(); ++i)
    if (fibers_[i].plan.site.is_attached()) loads[fibers_[i].plan.site.body] += fiber_loads_[i];
}

void Fibers::add_affine_response(Points f, std::span<Vector6> loads) const {
  ASTERFLOW_REQUIRE(f.size() == node_count());
  parallel_for("Fibers::add_affine_response", static_cast<long>(count()), [&](long i) {
    Fiber const& fiber = fibers_[i];
    fiber_loads_[i].setZero();
    fiber.response.add_affine(f.subspan(first_node_[i], fiber.properties.n_node), fiber_loads_[i]);
  });
  add_to_bodies(loads);
}

void Fibers::add_body_resistance(std::span<Matrix6> resistances) const {
  for (Fiber const& fiber : fibers_)
    if (fiber.plan.site.is_attached()) resistances[fiber.plan.site.body] += fiber.response.body_resistance();
}

void Fibers::add_own_flow(ConstPoints f, Points u) const {
  if (!has_nonlocal_) return;
  parallel_for("Fibers::add_own_flow", static_cast<long>(count()), [&](long i) {
    std::size_t const first = first_node_[i], n = fibers_[i].properties.n_node;
    if (fibers_[i].properties.is_nonlocal) fibers_[i].own_flow.add(f.subspan(first, n), u.subspan(first, n));
  });
}

void Fibers::advance(ConstPoints u, std::span<Vector6 const> q, std::span<RigidPose const> poses) {
  ASTERFLOW_REQUIRE(u.size() == node_count());
  parallel_for("Fibers::advance", static_cast<long>(count()), [&](long i) {
    Fiber& fiber = fibers_[i];
    MinusEndSite const& site = fiber.plan.site;
    Vector6 const motion = site.is_attached() ? q[site.body] : Vector6::Zero();
    fiber.response.advance(u.subspan(first_node_[i], fiber.properties.n_node), motion,
                           site.is_attached() ? &poses[site.body] : nullptr, fiber.predicted, fiber.trial);
    fiber.trial_ends = fiber.response.internal_forces(u.subspan(first_node_[i], fiber.properties.n_node), motion,
                                                      fiber.trial, fiber.trial_tension);
    estimate_error(fiber);
  });
}

void Fibers::estimate_error(Fiber& fiber) const {
  fiber.error = 0.0;
  int const n_past = usable_past(fiber);
  if (fiber.plan.is_newborn) return;
  sample(fiber.trial, fiber.coordinates, fiber.sampled, {});
  // Nothing is known of its acceleration, or it is that of a jump, which the step has taken up (late_share), and of what a fiber
  // forgets soon: what is linear about the predicted shape errs by the square.
  if (n_past < 2 || has_jumped(fiber)) {
    for (std::size_t i = 0; i < fiber.sampled.size(); ++i) {
      Vec3d const moved = fiber.sampled[i] - fiber.extrapolated[i];
      fiber.error = std::max(fiber.error, 0.5 * dot(moved, moved) / fiber.trial.length);
    }
    return;
  }
  double const factor = n_past < 3 ? 1.0 / 3.0 : milne_factor(dt_, dt_1_, dt_2_);
  for (std::size_t i = 0; i < fiber.sampled.size(); ++i)
    fiber.error = std::max(fiber.error, factor * norm(fiber.sampled[i] - fiber.extrapolated[i]));
}

double Fibers::error_estimate() const {
  if (fibers_.empty()) return 0.0;
  double largest = 0.0, squares = 0.0;
  for (Fiber const& fiber : fibers_) {
    largest = std::max(largest, fiber.error);
    squares += fiber.error * fiber.error;
  }
  return std::max(largest / tolerated_outlier, std::sqrt(squares / static_cast<double>(count())));
}

void Fibers::accept() {
  for (Fiber& fiber : fibers_) {
    if (fiber.plan.is_newborn) {
      std::swap(fiber.past[0], fiber.newborn);
      fiber.n_past = 1;
    }
    fiber.site = fiber.plan.site;
    std::swap(fiber.past[2], fiber.past[1]);
    std::swap(fiber.past[1], fiber.past[0]);
    std::swap(fiber.past[0], fiber.trial);
    std::swap(fiber.tension, fiber.trial_tension);
    fiber.ends = fiber.trial_ends;
    fiber.load = fiber.plan.load;
    fiber.late_force = fiber.plan.jump_at * fiber.plan.tip_jump;
    fiber.n_smooth = norm(fiber.plan.tip_jump) > 0 ? 0 : std::min(fiber.n_smooth + 1, 3);
    fiber.n_past = std::min(fiber.n_past + 1, 3);
  }
  dt_2_ = dt_1_;
  dt_1_ = dt_;
}

std::optional<Vec3d> Fibers::tip_velocity(std::size_t i) const {
  Fiber const& fiber = fibers_[i];
  if (fiber.n_past < 2) return std::nullopt;
  double const coordinate = fiber.past[0].length;
  Vec3d before{};
  sample(fiber.past[1], {&coordinate, 1}, {&before, 1}, {});
  return (plus_end(fiber.past[0]) - before) / dt_1_;
}

double Fibers::elastic_energy() const {
  double energy = 0.0;
  for (Fiber const& fiber : fibers_)
    energy += 0.5 * fiber.properties.bending_rigidity * squared_curvature(fiber.past[0]);
  return energy;
}

}  // namespace asterflow
