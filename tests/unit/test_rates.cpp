#include "backends/rates.hpp"

#include "backends/evaluator.hpp"
#include "cache_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

using namespace asterflow;

namespace {

class Rates : public CacheFixture {
 protected:
  static bool are_equal(SumRates const& a, SumRates const& b) { return a.pair == b.pair && a.plan == b.plan; }
};

}  // namespace

TEST_F(Rates, are_measured_once_and_the_same_ever_after) {
  SumRates const first = sum_rates("rotlet", 1e-3);
  // Any machine: a pair takes 1 ps to 1 us, and a plan's prediction is right within a factor 1000.
  EXPECT_GT(first.pair, 1e-3);
  EXPECT_LT(first.pair, 1e3);
  EXPECT_GT(first.plan, 1e-3);
  EXPECT_LT(first.plan, 1e3);
  EXPECT_TRUE(are_equal(sum_rates("rotlet", 1e-3), first));
  EXPECT_TRUE(are_equal(sum_rates("rotlet", 2e-3), first));  // to whole digits
}

TEST_F(Rates, are_measured_again_where_the_file_is_damaged) {
  sum_rates("rotlet", 1e-3);
  auto const file = only_file();
  std::ofstream(file, std::ios::app) << "0x1p-1";
  SumRates const second = sum_rates("rotlet", 1e-3);
  EXPECT_EQ(only_file(), file);
  EXPECT_TRUE(are_equal(sum_rates("rotlet", 1e-3), second));
}

TEST_F(Rates, are_built_in_where_nothing_can_be_stored) {
  std::ofstream(folder_.string()) << "a file where a folder should be";
  EXPECT_TRUE(are_equal(sum_rates("rotlet", 1e-3), built_in_rates("rotlet", 1e-3)));
  setenv("ASTERFLOW_CACHE", "off", 1);
  EXPECT_TRUE(are_equal(sum_rates("rotlet", 1e-3), built_in_rates("rotlet", 1e-3)));
}

TEST_F(Rates, built_in_are_those_of_a_flow_for_its_pressure) {
  EXPECT_TRUE(are_equal(built_in_rates("stresslet_pressure", 1e-7), built_in_rates("stresslet", 1e-7)));
}

TEST_F(Rates, are_implausible_where_waiting_threads_take_a_pair_for_forty_times_as_dear) {
  SumRates const table = built_in_rates("stresslet", 1e-6);
  EXPECT_TRUE(are_plausible(table, table));
  EXPECT_TRUE(are_plausible({3.0 * table.pair, 3.0 * table.plan}, table));  // a slower machine
  EXPECT_FALSE(are_plausible({40.0 * table.pair, 6.0 * table.plan}, table));
  EXPECT_FALSE(are_plausible({table.pair, 4.0 * table.plan}, table));
}
