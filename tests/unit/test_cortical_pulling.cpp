#include "mechanism/cortical_pulling.hpp"

#include "system/simulation.hpp"
#include "time_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace asterflow;

namespace {

CortexSurface ellipsoid() {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = {5.0, 3.0, 2.0}};
  return {make_shape(spec), 0.1};
}

// Share of the area of that ellipsoid with x > `least` (um), by quadrature of the parametrised surface.
double share_beyond(double least) {
  double total = 0.0, cap = 0.0;
  int const n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      double const z = (2.0 * i + 1) / n - 1, phi = M_PI * (j + 0.5) / n;
      double const r = std::sqrt(1 - z * z);
      Vec3d const d{z, r * std::cos(phi), r * std::sin(phi)};
      double const area = norm(Vec3d{3.0 * 2.0 * d.x, 5.0 * 2.0 * d.y, 5.0 * 3.0 * d.z});
      total += area;
      if (5.0 * d.x > least) cap += area;
    }
  return cap / total;
}

// A fiber held in space near one site, with chance only in the capture and detachment.
std::string scene_of(std::string const& pulling, std::string const& more = "") {
  return R"(
    [fluid]
    viscosity = 0.7
    [periphery]
    shape = "sphere"
    radius = 4.0
    [[fiber]]
    minus_end = "clamped"
    growing = true
    nodes = 10
    direction = [0, 0, 1]
    length = 3.0
    [dynamic_instability]
    catastrophe_rate = 0.0
    [cortical_pulling]
    positions = [[0, 0, 4.0]]
    )" + pulling + R"(
    [run]
    interactions = "local"
    accuracy = 1e-4
    )" + more;
}

}  // namespace

TEST(CorticalPulling, sites_are_uniform_by_area) {
  CorticalPulling const pulling({.sites = 4000}, ellipsoid(), 7);
  double counted = 0;
  for (Vec3d x : pulling.sites()) {
    EXPECT_NEAR(std::pow(x.x / 5, 2) + std::pow(x.y / 3, 2) + std::pow(x.z / 2, 2), 1.0, 1e-12);
    counted += x.x > 2.5;
  }
  double const share = share_beyond(2.5);
  EXPECT_NEAR(counted / 4000, share, 4 * std::sqrt(share * (1 - share) / 4000));
}

TEST(CorticalPulling, even_sites_divide_the_area_and_keep_apart) {
  int const count = 200;
  CorticalPulling const pulling({.sites = count, .arrangement = CorticalPullingSpec::Arrangement::even}, ellipsoid(), 7);
  PointArray const& sites = pulling.sites();
  ASSERT_EQ(sites.size(), 200u);
  for (double const least : {-4.0, -1.0, 0.0, 2.5, 4.5})
    EXPECT_NEAR(std::count_if(sites.begin(), sites.end(), [&](Vec3d x) { return x.x > least; }),
                count * share_beyond(least), 1.0);
  double closest = 1e9;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    EXPECT_NEAR(std::pow(sites[i].x / 5, 2) + std::pow(sites[i].y / 3, 2) + std::pow(sites[i].z / 2, 2), 1.0, 1e-12);
    for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, norm(sites[i] - sites[j]));
  }
  EXPECT_GT(closest, 0.4);  // um; the mean area of a site is 0.67 um on a side
}

TEST(CorticalPulling, rate_is_constant_in_front_and_linear_behind_the_plane) {
  CorticalPulling const pulling({.capture_rate = 2.0, .posterior_pole_factor = 1.5, .posterior_plane_factor = 0.5},
                                ellipsoid(), 1);
  EXPECT_EQ(pulling.rate_at({-5, 0, 0}, 1.0), 2.0);
  EXPECT_EQ(pulling.rate_at({0.99, 0, 0}, 1.0), 2.0);
  EXPECT_NEAR(pulling.rate_at({1.0001, 0, 0}, 1.0), 1.0, 1e-3);
  EXPECT_NEAR(pulling.rate_at({3.0, 0, 0}, 1.0), 2.0, 1e-3);
  EXPECT_NEAR(pulling.rate_at({5.0, 0, 0}, 1.0), 3.0, 1e-3);
}

TEST(CorticalPulling, captures_once_a_site_and_at_the_rate) {
  CorticalPullingSpec const spec{.positions = {{0, 0, 2.0}, {5.0, 0, 0}}, .reach = 0.5, .capture_rate = 0.4};
  DynamicInstability tips({.catastrophe_rate = 0.0}, 3);
  CorticalPulling pulling(spec, ellipsoid(), 3);
  int const n = 3000;
  for (int i = 0; i < n; ++i) tips.add(i, 1.0), pulling.add_tip();
  std::vector<TipSurroundings> around(n);
  pulling.begin_step(1.5);
  for (int i = 0; i < n; ++i) pulling.surround(i, {{0, 0, 1.8}, {}, 1.5}, 0.0, around[i]);
  tips.advance(1.5, around);
  double captured = 0;
  for (auto const& tip : tips.trial_tips()) captured += tip.state == TipState::captured;
  double const expected = 1 - std::exp(-0.4 * 1.5);
  EXPECT_NEAR(captured / n, expected, 4 * std::sqrt(expected * (1 - expected) / n));
  auto const& first = tips.trial_tips()[0];  // one fiber a site
  EXPECT_EQ(pulling.capture(0, first, 0.5).size(), n);
  pulling.surround(1, {{0, 0, 1.8}, {}, 1.5}, 0.0, around[1]);
  ASSERT_EQ(around[1].capture_rates.size(), 1u);
  EXPECT_EQ(around[1].capture_rates[0].until, 0.5);
}

TEST(CorticalPulling, captures_at_a_time_that_does_not_depend_on_the_step) {
  // Two plus ends pass the reach of one site; the first to be captured holds it, and is let go.
  auto const captures = [](double dt) {
    CorticalPullingSpec const spec{
        .positions = {{0, 0, 2.0}, {0, 0.9, 2.0}}, .residence_time = 1.5, .reach = 0.5, .capture_rate = 3.0};
    DynamicInstability tips({.growth_speed = 0.5, .catastrophe_rate = 0.0, .rescue_rate = 20.0}, 4);
    CorticalPulling pulling(spec, ellipsoid(), 4);
    for (int i = 0; i < 2; ++i) tips.add(i, 1.0), pulling.add_tip();
    std::vector<double> times;
    std::vector<TipSurroundings> around(2);
    for (int step = 0; step * dt < 4.5 - 1e-9; ++step) {
      pulling.begin_step(dt);
      for (int i = 0; i < 2; ++i)
        pulling.surround(i, {{0, -1.2 + 0.5 * (step * dt + 0.3 * i), 1.7}, {0, 0.5, 0}, dt}, 0.0, around[i]);
      tips.advance(dt, around);
      auto const& trial = tips.trial_tips();
      auto const again = [&](std::vector<std::size_t> const& changed) {
        for (auto const i : changed) {
          around[i].capture_rates = pulling.rates(i);
          if (!trial[i].captured_at) tips.set_trial(i, tips.advanced(i, dt, around[i]));
        }
      };
      for (int i = 0; i < 2; ++i)
        if (trial[i].released_at) again(pulling.let_go(i, *trial[i].released_at));
      for (int i = 0; i < 2; ++i) {
        if (!trial[i].captured_at) continue;
        times.push_back(step * dt + *trial[i].captured_at);
        again(pulling.capture(i, trial[i], *trial[i].captured_at));
      }
      for (int i = 0; i < 2; ++i) pulling.advance(i, trial[i].state == TipState::captured, {}, 0.0);
      tips.accept();
      pulling.accept();
    }
    return times;
  };
  auto const one = captures(0.045), other = captures(0.005);
  ASSERT_GE(one.size(), 3u);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-9) << i;
}

TEST(CorticalPulling, holds_for_the_residence_time_on_average) {
  DynamicInstability tips({.catastrophe_rate = 0.0}, 5);
  int const n = 3000;
  for (int i = 0; i < n; ++i) tips.add(i, 100.0);
  std::vector<CaptureRate> const at_once{{1.0, 1e9}};
  std::vector<TipSurroundings> around(n, {.capture_rates = at_once, .detachment_rate = 1.0 / 20.0});
  tips.advance(1e-6, around);
  tips.accept();
  double held = 0.0;
  for (auto& one : around) one.capture_rates = {};
  for (int step = 0; step < 400; ++step) {
    tips.advance(0.5, around);
    for (auto const& tip : tips.trial_tips())
      held += tip.state == TipState::captured ? 0.5 : tip.released_at.value_or(0.0);
    tips.accept();
  }
  EXPECT_NEAR(held / n, 20.0, 4 * 20.0 / std::sqrt(double(n)));
}

TEST(CorticalPulling, pulls_the_captured_plus_end_and_keeps_it_at_the_cortex) {
  for (std::string const direction : {"fiber", "normal"}) {
    Simulation simulation(parse_scene(
        scene_of("capture_rate = 100.0\nresidence_time = 1e6\nreach = 2.0\ndirection = \"" + direction + "\""), "t.toml"));
    while (simulation.time() < 4.0) simulation.step(4.0);
    EXPECT_EQ(simulation.tip_state(0), TipState::captured);
    EXPECT_NEAR(simulation.fibers().shape(0).length, 3.9, 1e-9);  // grew to the margin of 0.1 um and stays
    EXPECT_LT(norm(simulation.fibers().ends(0).plus_end - Vec3d{0, 0, 3.0}), 1e-9);
    EXPECT_LT(norm(simulation.fibers().ends(0).minus_end - Vec3d{0, 0, 3.0}), 1e-6);
  }
}

TEST(CorticalPulling, shortens_the_fiber_as_its_body_comes_closer) {
  std::string const text = R"(
    [fluid]
    viscosity = 1.6
    [periphery]
    shape = "sphere"
    radius = 8.0
    [[body]]
    name = "pnc"
    shape = "sphere"
    radius = 2.0
    position = [0, 0, 0]
    [[fiber]]
    body = "pnc"
    minus_end = "clamped"
    growing = true
    nodes = 10
    position = [0, 0, 2]
    direction = [0, 0, 1]
    length = 5.5
    [dynamic_instability]
    catastrophe_rate = 0.0
    [cortical_pulling]
    positions = [[0, 0, 8.0]]
    capture_rate = 1000.0
    residence_time = 1e6
    [run]
    interactions = "local"
    accuracy = 1e-4
  )";
  Simulation simulation(parse_scene(text, "t.toml"));
  while (simulation.time() < 5.0) simulation.step(5.0);
  double const z = simulation.bodies()[0].pose().position.z;
  EXPECT_GT(z, 0.1);
  EXPECT_NEAR(z + 2.0 + simulation.fibers().shape(0).length, 7.9, 1e-5);
  // The pull drags the sphere and the fiber: 3 = (6 pi mu a + L / (2 c)) U.
  double const length = simulation.fibers().shape(0).length;
  double const drag = 6 * M_PI * 1.6 * 2.0 + length / (2 * slender_body_mobility(length, 0.0125, 1.6));
  EXPECT_NEAR(simulation.bodies()[0].motion()[2], 3.0 / drag, 1e-3 * 3.0 / drag);
}

TEST(CorticalPulling, moves_a_body_at_second_order_in_time_through_captures_and_releases) {
  auto const place = [](double dt) {
    return test::body_after(2.4, R"(
      [fluid]
      viscosity = 1.6
      [periphery]
      shape = "sphere"
      radius = 8.0
      [[body]]
      name = "pnc"
      shape = "sphere"
      radius = 2.0
      [[aster]]
      body = "pnc"
      position = [0.0, 0.0, 2.6]
      centrosome_radius = 0.5
      opening = 100.0
      count = 6
      length = 5.2
      nodes = 10
      growing = true
      [dynamic_instability]
      catastrophe_rate = 0.0
      rescue_rate = 5.0
      [cortical_pulling]
      sites = 30
      capture_rate = 1.0
      residence_time = 0.7
      [run]
      interactions = "local"
      accuracy = 1e-4
      seed = 2)", dt);
  };
  auto const [coarse, fine, order] = test::convergence_in_time(place, 0.1, 2);
  EXPECT_GT(norm(place(0.025)), 0.03);
  EXPECT_GT(order, 1.7) << coarse << " " << fine;
}

TEST(CorticalPulling, resumes_bit_for_bit_with_all_mechanisms) {
  std::string const text = R"(
    [periphery]
    shape = "sphere"
    radius = 6.0
    [[body]]
    name = "pnc"
    shape = "sphere"
    radius = 2.0
    position = [0.5, 0, 0]
    [[aster]]
    body = "pnc"
    position = [0, 2, 0]
    opening = 80
    count = 20
    length = 3.0
    nodes = 8
    growing = true
    [dynamic_instability]
    rescue_rate = 0.1
    [cytoplasmic_pulling]
    cargo_offset = 0.3
    [pushing]
    sliding = "friction"
    friction = 10.0
    minimal_catastrophe_rate = 0.5
    [cortical_pulling]
    sites = 30
    capture_rate = 0.2
    residence_time = 1.0
    dividing_body = "pnc"
    [run]
    interactions = "local"
    accuracy = 1e-2
    seed = 5
  )";
  Simulation whole(parse_scene(text, "t.toml")), resumed(parse_scene(text, "t.toml"));
  while (whole.time() < 4.0) whole.step(4.0);
  std::array<int, 5> n_state{};
  for (std::size_t i = 0; i < 20; ++i) ++n_state[static_cast<int>(whole.tip_state(i))];
  EXPECT_GT(n_state[static_cast<int>(TipState::pushing)], 0);
  EXPECT_GT(n_state[static_cast<int>(TipState::captured)], 0);
  resumed.restore(whole.time(), whole.restart());
  for (int i = 0; i < 40; ++i) {
    auto const a = whole.step(1e3), b = resumed.step(1e3);
    ASSERT_EQ(a.time, b.time);
    ASSERT_EQ(a.rejected, b.rejected);
  }
  EXPECT_EQ(whole.bodies()[0].state(), resumed.bodies()[0].state());
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(plus_end(whole.fibers().shape(i)), plus_end(resumed.fibers().shape(i)));
}
