#include "fiber/dynamic_instability.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "fiber/fibers.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

namespace {

enum Draw : std::uint64_t { next_event, first_phase };

// Time until a hazard of constant rate reaches its threshold, s.
double waiting_time(double missing_hazard, double rate) {
  return rate > 0 ? missing_hazard / rate : std::numeric_limits<double>::infinity();
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
  tip.is_growing = uniform_random(seed_, fiber, 0, first_phase) >= spec_.initially_shrinking;
  if (tip_of_fiber_.size() <= fiber) tip_of_fiber_.resize(fiber + 1, -1);
  tip_of_fiber_[fiber] = static_cast<int>(now_.size());
  now_.push_back(tip);
  trial_ = now_;
}

void DynamicInstability::advance(double dt, std::span<TipSurroundings const> surroundings) {
  ASTERFLOW_REQUIRE(surroundings.empty() || surroundings.size() == now_.size());
  trial_ = now_;
  for (std::size_t i = 0; i < trial_.size(); ++i)
    advance(trial_[i], dt, surroundings.empty() ? TipSurroundings{} : surroundings[i]);
}

void DynamicInstability::advance(Tip& tip, double dt, TipSurroundings surroundings) const {
  double left = dt;
  tip.is_newborn = false;
  while (true) {
    double const missing = exponential_random(seed_, tip.fiber, tip.event, next_event) - tip.hazard;
    double const rate = tip.is_growing ? spec_.catastrophe_rate * surroundings.catastrophe_factor : spec_.rescue_rate;
    double const speed = tip.is_growing ? spec_.growth_speed * surroundings.growth_factor : -spec_.shrinkage_speed;
    double const until_switch = waiting_time(missing, rate);
    double const until_end =
        tip.is_growing ? waiting_time(std::max(surroundings.clearance, 0.0), speed + surroundings.approach_speed)
                       : (tip.length - spec_.minimal_length) / spec_.shrinkage_speed;
    double const interval = std::min({left, until_switch, until_end});
    tip.length += speed * interval;
    surroundings.clearance -= (speed + surroundings.approach_speed) * interval;
    if (interval == left && left < until_switch && left < until_end) {
      tip.hazard += rate * interval;
      return;
    }
    left -= interval;
    tip.hazard = 0.0;
    ++tip.event;
    bool const is_gone = !tip.is_growing && until_end <= until_switch;
    tip.is_growing = !tip.is_growing;
    if (is_gone) {
      tip.length = spec_.minimal_length;
      tip.is_newborn = true;
      surroundings = {};
    }
  }
}

void DynamicInstability::plan(Fibers& fibers) const {
  for (Tip const& tip : trial_) {
    auto& plan = fibers.plan(tip.fiber);
    plan.length = tip.length;
    plan.is_newborn = tip.is_newborn;
  }
}

TipState DynamicInstability::state_of(std::size_t fiber) const {
  if (fiber >= tip_of_fiber_.size() || tip_of_fiber_[fiber] < 0) return TipState::still;
  return now_[tip_of_fiber_[fiber]].is_growing ? TipState::growing : TipState::shrinking;
}

std::vector<NamedArray> DynamicInstability::state() const {
  std::vector<double> length, hazard;
  std::vector<std::int64_t> growing, event;
  for (Tip const& tip : now_) {
    length.push_back(tip.length);
    hazard.push_back(tip.hazard);
    growing.push_back(tip.is_growing);
    event.push_back(static_cast<std::int64_t>(tip.event));
  }
  return {NamedArray::of("dynamic_instability/length", length, "um"),
          NamedArray::of("dynamic_instability/hazard", hazard, ""),
          NamedArray::of("dynamic_instability/is_growing", growing),
          NamedArray::of("dynamic_instability/event", event)};
}

void DynamicInstability::restore(std::span<NamedArray const> state) {
  std::size_t const n = now_.size();
  auto const& length = std::get<std::vector<double>>(find(state, "dynamic_instability/length", n).values);
  auto const& hazard = std::get<std::vector<double>>(find(state, "dynamic_instability/hazard", n).values);
  auto const& growing = std::get<std::vector<std::int64_t>>(find(state, "dynamic_instability/is_growing", n).values);
  auto const& event = std::get<std::vector<std::int64_t>>(find(state, "dynamic_instability/event", n).values);
  for (std::size_t i = 0; i < n; ++i)
    now_[i] = {now_[i].fiber, length[i], growing[i] != 0, hazard[i], static_cast<std::uint64_t>(event[i]), false};
  trial_ = now_;
}

}  // namespace asterflow
