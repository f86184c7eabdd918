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
  is_taken_.assign(sites_.size(), 0);
}

void CorticalPulling::add_tip() {
  now_.emplace_back();
  trial_ = now_;
}

double CorticalPulling::rate_at(Vec3d site, double plane) const {
  double const x = dot(site, spec_.posterior);
  if (x <= plane) return spec_.capture_rate;
  double const part = std::clamp((x - plane) / (pole_ - plane), 0.0, 1.0);
  return spec_.capture_rate *
         (spec_.posterior_plane_factor + part * (spec_.posterior_pole_factor - spec_.posterior_plane_factor));
}

double CorticalPulling::reachable(Vec3d place, double plane, std::vector<std::pair<int, double>>& rates) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    if (is_taken_[i] || norm(sites_[i] - place) > spec_.reach) continue;
    rates.emplace_back(static_cast<int>(i), rate_at(sites_[i], plane));
    sum += rates.back().second;
  }
  return sum;
}

void CorticalPulling::surround(std::size_t tip, Vec3d place, double plane, TipSurroundings& surroundings) const {
  std::vector<std::pair<int, double>> rates;
  surroundings.capture_rate = reachable(place, plane, rates);
  surroundings.detachment_rate = 1.0 / spec_.residence_time;
  surroundings.captured_speed = now_[tip].speed;
}

std::vector<std::size_t> CorticalPulling::assign(std::span<DynamicInstability::Tip const> trial, ConstPoints places,
                                                 double plane) {
  trial_ = now_;
  std::vector<std::size_t> captured, late;
  for (std::size_t i = 0; i < trial.size(); ++i)
    if (trial[i].captured_at) captured.push_back(i);
  std::sort(captured.begin(), captured.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(*trial[a].captured_at, trial[a].fiber) < std::pair(*trial[b].captured_at, trial[b].fiber);
  });
  std::vector<char> is_given(sites_.size(), 0);
  for (std::size_t const i : captured) {
    std::vector<std::pair<int, double>> rates;
    double rest = reachable(places[i], plane, rates) * uniform_random(seed_, trial[i].fiber, trial[i].event, which_site);
    int site = -1;
    for (auto const& [candidate, rate] : rates) {
      if (rest > 0) site = candidate;
      rest -= rate;
    }
    if (site < 0 || is_given[site]) {
      late.push_back(i);
      continue;
    }
    is_given[site] = 1;
    trial_[i] = {.site = site};
  }
  return late;
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

void CorticalPulling::accept() {
  now_ = trial_;
  std::fill(is_taken_.begin(), is_taken_.end(), 0);
  for (Hold const& hold : now_)
    if (hold.site >= 0) is_taken_[hold.site] = 1;
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
  accept();
}

}  // namespace asterflow
