#include "system/plus_ends.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

// A tip is met by the cortex as by its tangent plane, along the tangent of the fiber; below this slope it grows along it.
constexpr double least_slope = 0.05;

// Growth is exact for a compression that is linear in the length; a compression linear in time would make the mean growth
// the logarithmic one. This share of the difference counts as error: errors of the length relax in the contact.
constexpr double error_share = 0.1;

double logarithmic_mean(double a, double b) {
  double const ratio = a / b;
  return std::abs(ratio - 1) < 1e-6 ? 0.5 * (a + b) : (a - b) / std::log(ratio);
}

// The root of a decreasing function in [low, high], by false position with the Illinois rule.
template <class Function>
double root(Function const& f, double low, double high, double tolerance) {
  double f_low = f(low), f_high = f(high);
  if (f_low <= 0) return low;
  if (f_high >= 0) return high;
  for (int iteration = 0; iteration < 100 && high - low > tolerance; ++iteration) {
    double const middle = (low * f_high - high * f_low) / (f_high - f_low);
    double const f_middle = f(middle);
    if (std::abs(f_middle) < tolerance) return middle;
    if (f_middle > 0) {
      low = middle, f_low = f_middle, f_high *= 0.5;
    } else {
      high = middle, f_high = f_middle, f_low *= 0.5;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

PlusEnds::PlusEnds(Scene const& scene) : growth_(*scene.dynamic_instability, scene.run.seed) {
  if (!scene.periphery) return;
  cortex_.emplace(make_shape(scene.periphery->shape), scene.dynamic_instability->cortex_margin);
  if (scene.pushing) pushing_.emplace(*scene.pushing, *cortex_);
  if (!scene.cortical_pulling) return;
  auto const& spec = *scene.cortical_pulling;
  pulling_.emplace(spec, *cortex_, scene.run.seed);
  dividing_body_ = body_index(scene, spec.dividing_body);
  posterior_ = spec.posterior;
  fixed_plane_ = spec.dividing_plane;
}

void PlusEnds::add(std::size_t fiber, double length, double spring_stiffness) {
  growth_.add(fiber, length);
  if (pushing_) pushing_->add_tip(spring_stiffness);
  if (pulling_) pulling_->add_tip();
  surroundings_.emplace_back();
  velocities_.emplace_back();
  speeds_.push_back(0.0);
  errors_.push_back(0.0);
}

double PlusEnds::length_at_rest(double length, Vec3d plus_end, Vec3d tangent) const {
  if (!pushing_) return length;
  for (int pass = 0; pass < 5; ++pass) {  // by Newton
    NearCortex const cortex = cortex_->near(plus_end);
    double const slope = dot(tangent, cortex.normal), missing = pushing_->contact_distance() - cortex.distance;
    if (slope <= least_slope || (pass == 0 && missing <= 0)) break;
    length -= missing / slope;
    plus_end -= (missing / slope) * tangent;
  }
  return length;
}

// Of the material at the plus end, um/s: right to first order in dt, so that contact begins when it should to second order.
Vec3d PlusEnds::tip_velocity(std::size_t fiber, Fibers const& fibers, std::span<RigidPose const> poses,
                             std::span<Vector6 const> motions) const {
  if (auto const velocity = fibers.tip_velocity(fiber)) return *velocity;
  if (!fibers.site(fiber).is_attached()) return {};
  int const body = fibers.site(fiber).body;
  return velocity_of_motion(motions[body], plus_end(fibers.shape(fiber)) - poses[body].position);
}

TipSurroundings PlusEnds::surroundings(std::size_t i, Fibers const& fibers, std::span<RigidPose const> poses,
                                       std::span<Vector6 const> motions, double dt) {
  TipSurroundings around;
  std::size_t const fiber = growth_.tips()[i].fiber;
  Centreline const& shape = fibers.shape(fiber);
  Vec3d const tip = plus_end(shape), tangent = shape.tangents.back();
  NearCortex const cortex = cortex_->near(tip);
  double const slope = dot(tangent, cortex.normal);
  double const contact = pushing_ ? pushing_->contact_distance() : 0.0;
  velocities_[i] = tip_velocity(fiber, fibers, poses, motions);
  if (slope > least_slope) {
    around.clearance = std::max(0.0, cortex.distance - contact) / slope;
    around.approach_speed = dot(velocities_[i], cortex.normal) / slope;
  } else if (slope > 0 && cortex.distance < contact) {
    around.clearance = 0.0;
  }
  double const growth_speed = growth_.spec().growth_speed;
  if (pushing_) pushing_->surround(i, growth_.spec().catastrophe_rate, around);
  if (pulling_) {
    double const speed = growth_.tips()[i].state == TipState::pushing ? 0.0 : growth_speed;
    double const approach = speed + around.approach_speed;
    pulling_->surround(i, {tip, velocities_[i] + speed * tangent, speed > 0 && approach > 0 ? around.clearance / approach : dt},
                       plane_, around);
  }
  return around;
}

// In order of time: sites that let go are free from then on, those that capture are taken.
void PlusEnds::share_sites(double dt) {
  auto const& trial = growth_.trial_tips();
  std::vector<char> is_settled(trial.size(), 0);
  auto const advance_again = [&](std::vector<std::size_t> const& changed) {
    for (std::size_t const i : changed) {
      surroundings_[i].capture_rates = pulling_->rates(i);
      if (!is_settled[i]) growth_.set_trial(i, growth_.advanced(i, dt, surroundings_[i]));
    }
  };
  for (std::size_t i = 0; i < trial.size(); ++i)
    if (trial[i].released_at && growth_.tips()[i].state == TipState::captured)
      advance_again(pulling_->let_go(i, *trial[i].released_at));
  while (true) {
    std::optional<std::size_t> next;
    for (std::size_t i = 0; i < trial.size(); ++i)
      if (trial[i].captured_at && !is_settled[i] && (!next || *trial[i].captured_at < *trial[*next].captured_at)) next = i;
    if (!next) return;
    is_settled[*next] = 1;
    advance_again(pulling_->capture(*next, trial[*next], *trial[*next].captured_at));
  }
}

// What held a tip acts until it is let go.
void PlusEnds::plan_release(std::size_t i, Fibers& fibers) {
  auto const& trial = growth_.trial_tips()[i];
  bool const has_pushed = growth_.tips()[i].state == TipState::pushing;
  Vec3d const force = has_pushed ? pushing_->last_force(i) : pulling_->last_pull(i);
  auto& plan = fibers.plan(trial.fiber);
  plan.tip.force += (*trial.released_at / dt_) * force;
  plan.tip_jump = -force;
  plan.jump_at = *trial.released_at / dt_;
}

void PlusEnds::plan_loads(std::size_t i, Fibers& fibers) {
  auto const& trial = growth_.trial_tips()[i];
  if (trial.released_at) plan_release(i, fibers);
  if (trial.contact_at && trial.state == TipState::pushing) {
    Centreline const& shape = fibers.shape(trial.fiber);
    Vec3d const velocity = velocities_[i] + growth_.spec().growth_speed * shape.tangents.back();
    pushing_->make_contact(i, plus_end(shape) + *trial.contact_at * velocity, dt_ - *trial.contact_at);
  }
}

void PlusEnds::plan(double dt, Fibers& fibers, std::span<RigidPose const> poses, std::span<Vector6 const> motions) {
  dt_ = dt;
  if (!cortex_) {
    growth_.advance(dt);
    growth_.plan(fibers);
    return;
  }
  plane_ = fixed_plane_;
  if (dividing_body_ >= 0) {  // in the middle of the step
    Vec3d const velocity = to_vec3(motions[dividing_body_].head<3>());
    plane_ = dot(poses[dividing_body_].position + 0.5 * dt * velocity, posterior_);
  }
  if (pulling_) pulling_->begin_step(dt);
  auto const n = static_cast<long>(surroundings_.size());
  parallel_for("PlusEnds::surroundings", n,
               [&](long i) { surroundings_[i] = surroundings(i, fibers, poses, motions, dt); });
  growth_.advance(dt, surroundings_);
  if (pushing_) pushing_->begin_step();
  if (pulling_) share_sites(dt);
  growth_.plan(fibers);
  for (long i = 0; i < n; ++i) plan_loads(i, fibers);
}

// The length at the end of the step for which growth and the compression that it causes agree.
double PlusEnds::pushing_length(std::size_t i, TipAnswer const& answer, Vec3d tangent, double planned) const {
  auto const& trial = growth_.trial_tips()[i];
  double const time = dt_ - trial.contact_at.value_or(0.0), pushed = growth_.spec().growth_speed * time;
  double const planned_factor = surroundings_[i].pushing_growth_factor;
  auto const excess = [&](double length) {
    Vec3d const position = answer.position + (length - planned) * tangent;
    TipLoad const load = pushing_->load(i, position, answer.compliance, tangent, dt_);
    double const compression = std::max(0.0, -dot(balanced_force(load, position, answer.compliance), tangent));
    TipSurroundings around;
    pushing_->surround(i, growth_.spec().catastrophe_rate, time, compression, around);
    return planned + pushed * (around.pushing_growth_factor - planned_factor) - length;
  };
  TipSurroundings unloaded;
  pushing_->surround(i, growth_.spec().catastrophe_rate, time, 0.0, unloaded);
  return root(excess, planned - pushed * planned_factor,
              planned + pushed * (unloaded.pushing_growth_factor - planned_factor), 1e-9);
}

void PlusEnds::hold_pushing(std::size_t i, Fibers& fibers, TipAnswer const& answer) {
  auto const& trial = growth_.trial_tips()[i];
  auto& plan = fibers.plan(trial.fiber);
  Vec3d const tangent = fibers.predicted_shape(trial.fiber).tangents.back();
  double const length = pushing_length(i, answer, tangent, plan.length);
  Vec3d const position = answer.position + (length - plan.length) * tangent;
  TipLoad const load = pushing_->load(i, position, answer.compliance, tangent, dt_);
  double const compression = std::max(0.0, -dot(balanced_force(load, position, answer.compliance), tangent));
  TipSurroundings around = surroundings_[i];
  double const pushed = dt_ - trial.contact_at.value_or(0.0);
  pushing_->surround(i, growth_.spec().catastrophe_rate, pushed, compression, around);
  errors_[i] = error_share * pushed * growth_.spec().growth_speed *
               std::abs(around.pushing_growth_factor - logarithmic_mean(pushing_->growth_factor_before(i),
                                                                        pushing_->growth_factor(compression)));
  growth_.set_trial(i, growth_.advanced(i, dt_, around));
  growth_.plan(fibers, i);
  if (trial.released_at) plan_release(i, fibers);  // the load brought its catastrophe into the step
  if (trial.state != TipState::pushing) return;
  plan.tip.stiffness = load.stiffness;
  plan.tip.anchor = load.anchor;
  plan.tip.force += load.force;
}

void PlusEnds::hold_captured(std::size_t i, Fibers& fibers, TipAnswer const& answer) {
  auto trial = growth_.trial_tips()[i];
  auto& plan = fibers.plan(trial.fiber);
  Vec3d const tangent = fibers.predicted_shape(trial.fiber).tangents.back();
  double const held = dt_ - trial.captured_at.value_or(0.0);
  Vec3d const pull = pulling_->pull(answer.position, tangent), mean = (held / dt_) * pull;
  plan.tip.force += mean;
  if (trial.captured_at) {
    plan.tip_jump = pull;
    plan.jump_at = 1 - held / dt_;
  }
  double const start = plan.length - surroundings_[i].captured_speed * held;
  double const wanted = pulling_->length_at_cortex(plan.length, answer.position + answer.compliance * mean, tangent);
  double const length = std::max(std::min(wanted, start + growth_.spec().growth_speed * held),
                                 std::min(start, growth_.spec().minimal_length));
  speeds_[i] = trial.captured_at ? 0.0 : (length - start) / held;
  trial.length = length;
  growth_.set_trial(i, trial);
  growth_.plan(fibers, i);
}

void PlusEnds::hold(Fibers& fibers, ConstPoints u, std::span<BodyMotionMap const> bodies) {
  std::fill(errors_.begin(), errors_.end(), 0.0);
  if (!pushing_ && !pulling_) return;
  parallel_for("PlusEnds::hold", static_cast<long>(surroundings_.size()), [&](long i) {
    auto const& trial = growth_.trial_tips()[i];
    if (!trial.is_held()) return;
    MinusEndSite const& site = fibers.plan(trial.fiber).site;
    TipAnswer const answer = fibers.tip_answer(
        trial.fiber, u, site.is_attached() ? bodies[site.body].predicted_motion() : Vector6::Zero());
    if (trial.state == TipState::pushing)
      hold_pushing(i, fibers, answer);
    else
      hold_captured(i, fibers, answer);
    fibers.prepare_again(trial.fiber, bodies);
  });
}

double PlusEnds::error_estimate() const {
  return errors_.empty() ? 0.0 : *std::max_element(errors_.begin(), errors_.end());
}

void PlusEnds::accept(Fibers const& fibers) {
  for (std::size_t i = 0; i < surroundings_.size(); ++i) {
    auto trial = growth_.trial_tips()[i];
    Centreline const& shape = fibers.shape(trial.fiber);
    Vec3d const tip = plus_end(shape), tangent = shape.tangents.back();
    if (pushing_) {
      Vec3d const force = fibers.ends(trial.fiber).plus_end - fibers.properties(trial.fiber).tip.force;
      pushing_->advance(i, trial.state == TipState::pushing, force, tip, tangent, dt_);
      if (trial.state == TipState::pushing && !pushing_->is_in_reach(tip)) {
        trial.state = TipState::growing;
        pushing_->advance(i, false, {}, tip, tangent, dt_);
        growth_.set_trial(i, trial);
      }
    }
    if (pulling_)
      pulling_->advance(i, trial.state == TipState::captured, pulling_->pull(tip, tangent), speeds_[i]);
  }
  growth_.accept();
  if (pushing_) pushing_->accept();
  if (pulling_) pulling_->accept();
}

std::vector<NamedArray> PlusEnds::state() const {
  auto arrays = growth_.state();
  if (pushing_) append(arrays, pushing_->state());
  if (pulling_) append(arrays, pulling_->state());
  return arrays;
}

void PlusEnds::restore(std::span<NamedArray const> state) {
  growth_.restore(state);
  if (pushing_) pushing_->restore(state);
  if (pulling_) pulling_->restore(state);
}

}  // namespace asterflow
