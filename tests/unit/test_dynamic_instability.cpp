#include "fiber/dynamic_instability.hpp"

#include "fiber_fixture.hpp"

#include <gtest/gtest.h>

using namespace asterflow;

namespace {

DynamicInstabilitySpec const busy{.catastrophe_rate = 0.3, .rescue_rate = 0.2};

DynamicInstability many_tips(DynamicInstabilitySpec const& spec, int n, std::uint64_t seed = 1) {
  DynamicInstability tips(spec, seed);
  for (int i = 0; i < n; ++i) tips.add(i, 2.0);
  return tips;
}

void run(DynamicInstability& tips, double duration, int n_step) {
  for (int i = 0; i < n_step; ++i) {
    tips.advance(duration / n_step);
    tips.accept();
  }
}

}  // namespace

TEST(DynamicInstability, history_does_not_depend_on_the_time_step) {
  auto coarse = many_tips(busy, 200), fine = many_tips(busy, 200);
  run(coarse, 60.0, 6);
  run(fine, 60.0, 997);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(coarse.tips()[i].event, fine.tips()[i].event);
    EXPECT_NEAR(coarse.tips()[i].length, fine.tips()[i].length, 1e-10);  // rounding of 997 sums
  }
}

TEST(DynamicInstability, rejected_step_leaves_no_trace) {
  auto tips = many_tips(busy, 50), reference = many_tips(busy, 50);
  tips.advance(10.0);
  run(tips, 5.0, 1);
  run(reference, 5.0, 1);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(tips.tips()[i].length, reference.tips()[i].length);
}

TEST(DynamicInstability, lengths_are_exponential_with_the_mean_of_growth_speed_over_rate) {
  auto tips = many_tips({.catastrophe_rate = 0.25}, 4000);
  run(tips, 200.0, 50);
  double mean = 0.0;
  for (auto const& tip : tips.tips()) mean += tip.length / 4000;
  EXPECT_NEAR(mean, 0.5 + 0.5 / 0.25, 4 * 2.0 / std::sqrt(4000.0));  // four standard deviations
}

TEST(DynamicInstability, growing_tip_turns_back_at_the_cortex_at_the_exact_time) {
  DynamicInstability tips({.catastrophe_rate = 0.0}, 1);
  tips.add(0, 2.0);
  TipSurroundings const cortex{.clearance = 1.0, .approach_speed = 0.5};
  tips.advance(1.5, {&cortex, 1});  // contact after 1 s, then 0.5 s of shrinking
  EXPECT_EQ(tips.trial_tips()[0].state, TipState::shrinking);
  EXPECT_NEAR(tips.trial_tips()[0].length, 2.0 + 0.5 - 0.25, 1e-14);
}

TEST(DynamicInstability, tip_born_against_the_cortex_does_not_stop_time) {
  DynamicInstability tips({.catastrophe_rate = 0.0}, 1);
  tips.add(0, 0.5);
  TipSurroundings const cortex{.clearance = -1.0};
  tips.advance(1.0, {&cortex, 1});
  EXPECT_TRUE(tips.trial_tips()[0].is_newborn);
  EXPECT_NEAR(tips.trial_tips()[0].length, 1.0, 1e-14);
}

TEST(DynamicInstability, restart_continues_the_same_history) {
  auto whole = many_tips(busy, 50), first = many_tips(busy, 50), second = many_tips(busy, 50);
  run(whole, 20.0, 10);
  run(first, 10.0, 5);
  second.restore(first.state());
  run(second, 10.0, 5);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(whole.tips()[i].length, second.tips()[i].length);
    EXPECT_EQ(whole.tips()[i].event, second.tips()[i].event);
  }
}

TEST(DynamicInstability, renucleated_fiber_is_straight_on_its_site) {
  Fibers fibers(1.0);
  MinusEndSite const site{.kind = MinusEnd::clamped, .position = {1, 2, 3}, .direction = {0, 0, 1}};
  fibers.add({.n_node = 8}, site, straight_centreline(site.position, site.direction, 0.6, 8));
  DynamicInstability tips({.catastrophe_rate = 0.0, .initially_shrinking = 1.0}, 1);
  tips.add(0, 0.6);
  auto const shear = [](Vec3d x) { return Vec3d{x.z, 0, 0}; };
  for (int i = 0; i < 3; ++i) {  // reaches the minimal length after 0.2 s
    fibers.begin_step();
    tips.advance(0.15);
    tips.plan(fibers);
    test::step(fibers, 0.15, shear);
    tips.accept();
    EXPECT_EQ(fibers.shape(0).length, tips.tips()[0].length);
    EXPECT_LT(norm(fibers.shape(0).minus_end - site.position), 1e-15);
    EXPECT_LT(norm(fibers.shape(0).tangents[0] - site.direction), 1e-15);
  }
  EXPECT_NEAR(fibers.shape(0).length, 0.5 + 0.5 * 0.25, 1e-12);
}
