#include "mechanism/cortical_pulling.hpp"

#include "base/random.hpp"
#include "base/stored_values.hpp"
#include "mechanism/cortical_sites.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

constexpr std::uint64_t which_site = 3;  // draw of a fiber, beside those of dynamic instability
constexpr double never = std::numeric_limits<double>::infinity();

// Farthest extent of a surface along an axis, um: the best of a grid, then steps to better neighbours that halve.
double extent(Shape const& shape, Vec3d axis) {
  auto const reach = [&](double theta, double phi) { return dot(axis, shape.point(theta, phi)); };
  constexpr int n = 40;
  double theta = 0.0, phi = 0.0, farthest = reach(0.0, 0.0);
  auto const try_at = [&](double t, double p) {
    if (!(reach(t, p) > farthest)) return false;
    theta = t, phi = p, farthest = reach(t, p);
    return true;
  };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) try_at(std::numbers::pi * i / n, std::numbers::pi * j / n);
  for (double step = std::numbers::pi / n; step > 1e-9;) {
    bool const is_better = try_at(theta + step, phi) || try_at(theta - step, phi) || try_at(theta, phi + step) ||
                           try_at(theta, phi - step);
    if (!is_better) step *= 0.5;
  }
  return farthest;
}

}  // namespace

CorticalPulling::CorticalPulling(CorticalPullingSpec const& spec, CortexSurface const& cortex, std::uint64_t seed)
    : spec_(spec), cortex_(cortex), seed_(seed), pole_(extent(cortex.shape(), spec.posterior)) {
  if (!spec.positions.empty())
    sites_.assign(spec.positions.begin(), spec.positions.end());
  else if (spec.arrangement == CorticalPullingSpec::Arrangement::even)
    sites_ = even_sites(cortex.shape(), spec.posterior, spec.sites);
  else
    sites_ = random_sites(cortex.shape(), spec.sites, seed);
}

void CorticalPulling::add_tip() {
  now_.emplace_back();
  trial_ = now_;
  visits_.emplace_back();
  rates_.emplace_back();
}

double CorticalPulling::rate_at(Vec3d site, double plane) const {
  double const x = dot(site, spec_.posterior);
  if (x <= plane) return spec_.capture_rate;
  double const part = std::clamp((x - plane) / (pole_ - plane), 0.0, 1.0);
  return spec_.capture_rate *
         (spec_.posterior_plane_factor + part * (spec_.posterior_pole_factor - spec_.posterior_plane_factor));
}

void CorticalPulling::begin_step(double dt) {
  dt_ = dt;
  trial_ = now_;
  available_.assign(sites_.size(), {0.0, never});
  for (Hold const& hold : now_)
    if (hold.site >= 0) available_[hold.site].from = never;
}

void CorticalPulling::surround(std::size_t tip, Path const& path, double plane, TipSurroundings& surroundings) {
  auto& visits = visits_[tip];
  visits.clear();
  double const a = dot(path.velocity, path.velocity), until = std::min(path.until, dt_);
  for (std::size_t i = 0; i < sites_.size(); ++i) {  // |site - start - t velocity| <= reach
    Vec3d const away = sites_[i] - path.start;
    double const b = dot(away, path.velocity), c = dot(away, away) - spec_.reach * spec_.reach;
    double const root = std::sqrt(std::max(b * b - a * c, 0.0));
    double const enter = c <= 0 ? 0.0 : b > root ? c / (b + root) : never;
    if (!(enter <= until) || (c > 0 && b * b < a * c)) continue;
    bool const stays = (b + root) >= a * until;
    visits.push_back({static_cast<int>(i), rate_at(sites_[i], plane), enter, stays ? dt_ : (b + root) / a});
  }
  set_rates(tip);
  surroundings.capture_rates = rates_[tip];
  surroundings.detachment_rate = 1.0 / spec_.residence_time;
  surroundings.captured_speed = now_[tip].speed;
}

void CorticalPulling::set_rates(std::size_t tip) {
  auto& rates = rates_[tip];
  rates.clear();
  std::vector<std::pair<double, double>> changes;  // of the rate, at a time
  for (Visit const& visit : visits_[tip]) {
    double const from = std::max(visit.enter, available_[visit.site].from);
    double const until = std::min(visit.leave, available_[visit.site].until);
    if (!(from < until)) continue;
    changes.emplace_back(from, visit.rate);
    changes.emplace_back(until, -visit.rate);
  }
  if (changes.empty()) return;
  std::sort(changes.begin(), changes.end());
  double rate = 0.0;
  for (auto const& [time, change] : changes) {
    if (time > 0) rates.push_back({time, std::max(rate, 0.0)});
    rate += change;
  }
}

std::vector<std::size_t> CorticalPulling::change(int site) {
  std::vector<std::size_t> changed;
  for (std::size_t tip = 0; tip < visits_.size(); ++tip)
    if (std::any_of(visits_[tip].begin(), visits_[tip].end(), [&](Visit const& v) { return v.site == site; })) {
      set_rates(tip);
      changed.push_back(tip);
    }
  return changed;
}

std::vector<std::size_t> CorticalPulling::let_go(std::size_t tip, double time) {
  int const site = now_[tip].site;
  available_[site].from = time;
  return change(site);
}

std::vector<std::size_t> CorticalPulling::capture(std::size_t tip, DynamicInstability::Tip const& trial, double time) {
  auto const reaches = [&](Visit const& visit) {
    auto const [from, until] = available_[visit.site];
    double const rounding = 1e-12 * dt_;
    return std::max(visit.enter, from) <= time + rounding && time <= std::min(visit.leave, until) + rounding;
  };
  double sum = 0.0;
  for (Visit const& visit : visits_[tip])
    if (reaches(visit)) sum += visit.rate;
  double rest = sum * uniform_random(seed_, trial.fiber, trial.event, which_site);
  int site = -1;
  for (Visit const& visit : visits_[tip]) {
    if (!reaches(visit)) continue;
    if (rest > 0) site = visit.site;
    rest -= visit.rate;
  }
  trial_[tip] = {.site = site};
  if (site < 0) return {};
  available_[site].until = time;
  return change(site);
}

Vec3d CorticalPulling::pull(Vec3d plus_end, Vec3d tangent) const {
  bool const is_along = spec_.direction == CorticalPullingSpec::Direction::fiber;
  return spec_.pull_force * (is_along ? tangent : cortex_.near(plus_end).normal);
}

double CorticalPulling::length_at_cortex(double length, Vec3d plus_end, Vec3d tangent) const {
  NearCortex const cortex = cortex_.near(plus_end);
  double const slope = dot(cortex.normal, tangent);
  return slope > 0.1 ? length + cortex.distance / slope : length;  // a fiber along the cortex cannot reach it
}

void CorticalPulling::advance(std::size_t tip, bool is_captured, Vec3d pull, double speed) {
  trial_[tip] = is_captured ? Hold{trial_[tip].site, pull, speed} : Hold{};
}

std::vector<NamedArray> CorticalPulling::state() const {
  std::vector<double> values;
  for (Hold const& h : now_) values.insert(values.end(), {double(h.site), h.pull.x, h.pull.y, h.pull.z, h.speed});
  return {{"cortical_pulling/hold", {now_.size(), 5}, values, ""}};
}

void CorticalPulling::restore(std::span<NamedArray const> state) {
  auto const& values = stored_values(state, "cortical_pulling/hold", 5 * now_.size());
  for (std::size_t i = 0; i < now_.size(); ++i) {
    double const* v = &values[5 * i];
    trial_[i] = {static_cast<int>(v[0]), {v[1], v[2], v[3]}, v[4]};
  }
  now_ = trial_;
}

}  // namespace asterflow
