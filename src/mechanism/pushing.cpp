#include "mechanism/pushing.hpp"

#include "base/stored_values.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

using Sliding = PushingSpec::Sliding;

// Free sliding: the force at this many d* is below one percent of the largest.
constexpr double free_reach = 5.0;

// The load of a tip that is stopped rises as this power of time, from 10 ms to 1 s (measured, 10 to 14 um long, scene of no
// sliding): the longer it lasts, the more of the fiber it bends.
constexpr double onset_power = 0.6;

// Of d* over the wall's force: what is stiffer than this holds that force without moving.
constexpr double least_compliance = 1e-12;

// x with x exp(x) = exp(log_z): Lambert's function, by Newton on x + log x = log_z.
double lambert(double log_z) {
  double x = log_z > 1.0 ? log_z - std::log(log_z) : std::exp(std::min(log_z, 0.0));
  for (int iteration = 0; iteration < 50; ++iteration) {
    double const step = (x + std::log(x) - log_z) * x / (1 + x);
    x = std::max(x - step, 1e-3 * x);
    if (std::abs(step) <= 1e-15 * x) break;
  }
  return x;
}

}  // namespace

Vec3d balanced_force(TipLoad const& load, Vec3d free_position, Matrix3 const& compliance) {
  Matrix3 const system = Matrix3::Identity() + load.stiffness * compliance;
  return to_vec3(system.lu().solve(to_eigen(load.force - load.stiffness * (free_position - load.anchor))));
}

void Pushing::add_tip(double spring_stiffness) {
  stiffness_.push_back(spring_stiffness);
  now_.emplace_back();
  trial_ = now_;
}

double Pushing::contact_distance() const {
  return spec_.sliding == Sliding::free ? free_reach * spec_.range : spec_.range;
}

double Pushing::growth_factor(double compression) const { return std::exp(-compression / spec_.stall_force); }

// A spring's load rises as (time in contact)^p: its mean over part of it, as a share between the first and the last value.
double Pushing::share_of_end(Contact const& contact, double pushed) const {
  bool const is_old = contact.age >= 100 * pushed;  // then it rises linearly
  if (spec_.sliding == Sliding::free || is_old) return 0.5;
  constexpr double p = onset_power;
  double const x = contact.age / pushed, first = std::pow(x, p), last = std::pow(x + 1, p);
  double const mean = (std::pow(x + 1, p + 1) - std::pow(x, p + 1)) / (p + 1);
  return (mean - first) / (last - first);
}

void Pushing::surround(std::size_t tip, double rate_without_load, double pushed, double compression,
                       TipSurroundings& surroundings) const {
  double const before = growth_factor(now_[tip].compression), after = growth_factor(compression);
  auto const rate = [&](double factor) {
    return std::max(rate_without_load / factor, spec_.minimal_catastrophe_rate);
  };
  surroundings.can_push = true;
  // Exact for a compression that grows in proportion to the length, however stiff: with x = change of F_c / F_P,
  // mean V_g / V_g0 = exp(-F_c / F_P) x / (exp(x) - 1); a change that comes early in the step counts for more.
  double const share = share_of_end(trial_[tip], pushed);
  double const x = 2 * share * (compression - now_[tip].compression) / spec_.stall_force;
  surroundings.pushing_growth_factor = before * (std::abs(x) < 1e-6 ? 1 - 0.5 * x : x / std::expm1(x));
  surroundings.pushing_catastrophe_rate = rate(before) + share * (rate(after) - rate(before));
}

void Pushing::surround(std::size_t tip, double rate_without_load, TipSurroundings& surroundings) const {
  surround(tip, rate_without_load, 0.0, now_[tip].compression, surroundings);
}

void Pushing::make_contact(std::size_t tip, Vec3d reached, double left) {
  bool const is_pinned = spec_.sliding == Sliding::none;  // where it is: its spring is at rest then
  trial_[tip] = {.is_made = true,
                 .anchor = is_pinned ? reached : cortex_.at_distance(reached, contact_distance()),
                 .sliding_time = left};
}

// Of second order from the beginning: on contact the spring is not loaded, so the anchor is at rest, and the trapezoidal
// rule from rest is backward Euler over half the time.
TimeScheme Pushing::scheme(Contact const& contact, double dt) const {
  double const time = contact.sliding_time.value_or(dt);
  return contact.span > 0 ? second_order_scheme(time, contact.span) : backward_euler(0.5 * time);
}

// The anchor's slip is eliminated: K (I - n n) (X - X_att) = zeta (a0 X_att - a0 A) / dt.
TipLoad Pushing::spring(std::size_t tip, double dt) const {
  Contact const& contact = trial_[tip];
  double const k = stiffness_[tip], across = std::max(k, spec_.stall_force / spec_.range);
  Vec3d expected = contact.anchor;  // at the end of the step
  if (contact.span > 0) expected += (dt / contact.span) * (contact.anchor - contact.anchor_before);
  expected = cortex_.at_distance(expected, contact_distance());
  Eigen::Vector3d const n = to_eigen(cortex_.near(expected).normal);
  if (spec_.sliding == Sliding::none)
    return {{}, k * Matrix3::Identity() + (across - k) * n * n.transpose(), contact.anchor};
  TimeScheme const scheme = this->scheme(contact, dt);
  Vec3d const history = (1.0 / scheme.a0) * (scheme.a1 * contact.anchor + scheme.a2 * contact.anchor_before);
  double const along = k / (1 + k * scheme.dt / (scheme.a0 * spec_.friction));
  Matrix3 const normal = n * n.transpose();
  Vec3d const anchor = history - normal * (history - expected);
  return {{}, across * normal + along * (Matrix3::Identity() - normal), anchor};
}

// f = A exp(-d / d*), A = F_P (n . X_s), d = d_free + C f with the normal compliance C: with y = f C / d*,
// y exp(y) = A C / d* exp(-d_free / d*).
TipLoad Pushing::repulsion(Vec3d free_position, Matrix3 const& compliance, Vec3d tangent) const {
  TipLoad load;
  load.anchor = free_position;
  for (int pass = 0; pass < 6; ++pass) {  // the normal is that of the balanced position
    NearCortex const cortex = cortex_.near(load.anchor);
    Vec3d const n = cortex.normal;
    double const amplitude = spec_.stall_force * dot(n, tangent);
    if (amplitude <= 0) return {{}, Matrix3::Zero(), free_position};
    double const c = std::max(dot(n, compliance * n), least_compliance * spec_.range / amplitude);
    double const free_distance = cortex.distance + dot(n, load.anchor - free_position);
    double const force =
        spec_.range / c * lambert(std::log(amplitude * c / spec_.range) - free_distance / spec_.range);
    load.force = -force * n;
    load.stiffness = force / spec_.range * (to_eigen(n) * to_eigen(n).transpose());
    load.anchor = free_position + compliance * load.force;
  }
  return load;
}

TipLoad Pushing::load(std::size_t tip, Vec3d free_position, Matrix3 const& compliance, Vec3d tangent, double dt) const {
  return spec_.sliding == Sliding::free ? repulsion(free_position, compliance, tangent) : spring(tip, dt);
}

void Pushing::advance(std::size_t tip, bool is_pushing, Vec3d force, Vec3d position, Vec3d tangent, double dt) {
  Contact& contact = trial_[tip];
  if (!is_pushing) {
    contact = {};
    return;
  }
  Vec3d anchor = contact.anchor;
  if (spec_.sliding == Sliding::friction) {
    TimeScheme const scheme = this->scheme(contact, dt);
    double const k = stiffness_[tip] * scheme.dt / spec_.friction;
    Vec3d const history = scheme.a1 * contact.anchor + scheme.a2 * contact.anchor_before;
    anchor = cortex_.at_distance((1.0 / (scheme.a0 + k)) * (history + k * position), contact_distance());
  }
  double const span = contact.sliding_time.value_or(dt);
  contact = {true, contact.age + span, span, anchor, contact.anchor, force, std::max(0.0, -dot(force, tangent))};
}

bool Pushing::is_in_reach(Vec3d position) const {
  return spec_.sliding != Sliding::free || cortex_.near(position).distance < 1.5 * contact_distance();
}

std::vector<NamedArray> Pushing::state() const {
  std::vector<double> values;
  for (Contact const& c : now_) {
    values.insert(values.end(), {double(c.is_made), c.age, c.span, c.compression});
    for (Vec3d v : {c.anchor, c.anchor_before, c.force}) values.insert(values.end(), {v.x, v.y, v.z});
  }
  return {{"pushing/contacts", {now_.size(), 13}, values, ""}};
}

void Pushing::restore(std::span<NamedArray const> state) {
  auto const& values = stored_values(state, "pushing/contacts", 13 * now_.size());
  for (std::size_t i = 0; i < now_.size(); ++i) {
    double const* v = &values[13 * i];
    now_[i] = {v[0] != 0, v[1], v[2], {v[4], v[5], v[6]}, {v[7], v[8], v[9]}, {v[10], v[11], v[12]}, v[3]};
  }
  trial_ = now_;
}

}  // namespace asterflow
