#include "fiber/dynamic_instability.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "fiber/fibers.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

namespace {

enum Draw : std::uint64_t { next_event, first_phase, capture };

constexpr double never = std::numeric_limits<double>::infinity();

// Time until a hazard of constant rate reaches its threshold, s.
double waiting_time(double missing_hazard, double rate) {
  return rate > 0 ? missing_hazard / rate : never;
}

NamedArray const& find(std::span<NamedArray const> arrays, std::string_view name, std::size_t size) {
  for (NamedArray const& array : arrays)
    if (array.name == name && array.shape == std::vector<std::size_t>{size}) return array;
  throw SceneError("the stored state has no array " + std::string(name) + " of the scene's size");
}

}  // namespace

void DynamicInstability::add(std::size_t fiber, double length) {
  ASTERFLOW_REQUIRE(length > 0);
  Tip tip{.fiber = fiber, .length = std::max(length, spec_.minimal_length)};
  if (uniform_random(seed_, fiber, 0, first_phase) < spec_.initially_shrinking) tip.state = TipState::shrinking;
  if (tip_of_fiber_.size() <= fiber) tip_of_fiber_.resize(fiber + 1, -1);
  tip_of_fiber_[fiber] = static_cast<int>(now_.size());
  now_.push_back(tip);
  trial_ = now_;
}

void DynamicInstability::advance(double dt, std::span<TipSurroundings const> surroundings) {
  ASTERFLOW_REQUIRE(surroundings.empty() || surroundings.size() == now_.size());
  for (std::size_t i = 0; i < now_.size(); ++i)
    trial_[i] = advanced(i, dt, surroundings.empty() ? TipSurroundings{} : surroundings[i]);
}

// What a tip does until its next event.
struct DynamicInstability::Course {
  double speed = 0.0;        // um/s, of lengthening
  double rate = 0.0;         // 1/s: catastrophe, rescue or detachment
  double capture_rate = 0.0;
  double until_end = never;  // s, to the cortex or to the minimal length
};

DynamicInstability::Course DynamicInstability::course(Tip const& tip, TipSurroundings const& around,
                                                      double capture_rate) const {
  double const spare = std::max(tip.length - spec_.minimal_length, 0.0);
  switch (tip.state) {
    case TipState::growing:
      return {spec_.growth_speed, spec_.catastrophe_rate, capture_rate,
              waiting_time(std::max(around.clearance, 0.0), spec_.growth_speed + around.approach_speed)};
    case TipState::pushing:
      return {spec_.growth_speed * around.pushing_growth_factor, around.pushing_catastrophe_rate, capture_rate, never};
    case TipState::captured:
      return {around.captured_speed, around.detachment_rate, 0.0, waiting_time(spare, -around.captured_speed)};
    default:
      return {-spec_.shrinkage_speed, spec_.rescue_rate, 0.0, spare / spec_.shrinkage_speed};
  }
}

// Catastrophe, rescue or detachment.
void DynamicInstability::switch_state(Tip& tip, double time) const {
  if (tip.is_held() && !tip.contact_at && !tip.captured_at) tip.released_at = time;
  tip.contact_at = tip.captured_at = std::nullopt;
  tip.state = tip.state == TipState::shrinking ? TipState::growing : TipState::shrinking;
  tip.hazard = tip.capture_hazard = 0.0;
  ++tip.event;
}

void DynamicInstability::reach_end(Tip& tip, TipSurroundings& around, double time) const {
  if (tip.state == TipState::growing && around.can_push) {
    tip.state = TipState::pushing;
    tip.contact_at = time;
    return;
  }
  bool const is_gone = tip.state == TipState::shrinking;
  switch_state(tip, time);
  if (is_gone) {
    tip.length = spec_.minimal_length;
    tip.is_newborn = true;
    around = {};
  }
}

DynamicInstability::Tip DynamicInstability::advanced(std::size_t index, double dt,
                                                     TipSurroundings const& surroundings) const {
  Tip tip = now_[index];
  TipSurroundings around = surroundings;
  tip.is_newborn = false;
  tip.contact_at = tip.captured_at = tip.released_at = std::nullopt;
  double left = dt;
  while (true) {
    bool const has_rate = !around.capture_rates.empty();
    Course const course = this->course(tip, around, has_rate ? around.capture_rates[0].rate : 0.0);
    double const until_change = has_rate ? std::max(around.capture_rates[0].until - (dt - left), 0.0) : never;
    auto const missing = [&](Draw draw, double hazard) {
      return exponential_random(seed_, tip.fiber, tip.event, draw) - hazard;
    };
    double const until_switch = waiting_time(missing(next_event, tip.hazard), course.rate);
    double const until_capture =
        course.capture_rate > 0 ? waiting_time(missing(capture, tip.capture_hazard), course.capture_rate) : never;
    double const interval = std::min({left, until_switch, until_capture, until_change, course.until_end});
    tip.length += course.speed * interval;
    around.clearance -= (course.speed + around.approach_speed) * interval;
    tip.hazard += course.rate * interval;
    tip.capture_hazard += course.capture_rate * interval;
    if (left < std::min({until_switch, until_capture, until_change, course.until_end})) return tip;
    left -= interval;
    if (interval == until_change) {
      around.capture_rates = around.capture_rates.subspan(1);
    } else if (interval == course.until_end && course.until_end <= until_switch) {
      reach_end(tip, around, dt - left);
    } else if (interval == until_capture) {
      tip.state = TipState::captured;
      tip.captured_at = dt - left;
      tip.hazard = tip.capture_hazard = 0.0;
      ++tip.event;
    } else {
      switch_state(tip, dt - left);
    }
  }
}

void DynamicInstability::plan(Fibers& fibers) const {
  for (std::size_t i = 0; i < trial_.size(); ++i) plan(fibers, i);
}

void DynamicInstability::plan(Fibers& fibers, std::size_t i) const {
  Tip const& tip = trial_[i];
  auto& plan = fibers.plan(tip.fiber);
  plan.length = tip.length;
  plan.is_newborn = tip.is_newborn;
}

TipState DynamicInstability::state_of(std::size_t fiber) const {
  if (fiber >= tip_of_fiber_.size() || tip_of_fiber_[fiber] < 0) return TipState::still;
  return now_[tip_of_fiber_[fiber]].state;
}

std::vector<NamedArray> DynamicInstability::state() const {
  std::vector<double> length, hazard, capture_hazard;
  std::vector<std::int64_t> states, event;
  for (Tip const& tip : now_) {
    length.push_back(tip.length);
    hazard.push_back(tip.hazard);
    capture_hazard.push_back(tip.capture_hazard);
    states.push_back(static_cast<std::int64_t>(tip.state));
    event.push_back(static_cast<std::int64_t>(tip.event));
  }
  return {NamedArray::of("dynamic_instability/length", length, "um"),
          NamedArray::of("dynamic_instability/hazard", hazard, ""),
          NamedArray::of("dynamic_instability/capture_hazard", capture_hazard, ""),
          NamedArray::of("dynamic_instability/state", states),
          NamedArray::of("dynamic_instability/event", event)};
}

void DynamicInstability::restore(std::span<NamedArray const> state) {
  std::size_t const n = now_.size();
  auto const& length = std::get<std::vector<double>>(find(state, "dynamic_instability/length", n).values);
  auto const& hazard = std::get<std::vector<double>>(find(state, "dynamic_instability/hazard", n).values);
  auto const& capture_hazard =
      std::get<std::vector<double>>(find(state, "dynamic_instability/capture_hazard", n).values);
  auto const& states = std::get<std::vector<std::int64_t>>(find(state, "dynamic_instability/state", n).values);
  auto const& event = std::get<std::vector<std::int64_t>>(find(state, "dynamic_instability/event", n).values);
  for (std::size_t i = 0; i < n; ++i)
    now_[i] = {.fiber = now_[i].fiber,
               .length = length[i],
               .state = static_cast<TipState>(states[i]),
               .hazard = hazard[i],
               .capture_hazard = capture_hazard[i],
               .event = static_cast<std::uint64_t>(event[i]),
               .is_newborn = false,
               .contact_at = {},
               .captured_at = {},
               .released_at = {}};
  trial_ = now_;
}

}  // namespace asterflow
