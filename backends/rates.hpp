#pragma once
// What direct and fast sums cost here: time per pair, and the time of a fast sum over that predicted with its plan.
// Measured at first use for every kernel, accuracy to whole digits and number of threads, on a few thousand points, and stored
// in the folder of base/cache_folder.hpp, so that later choices are the same. The first of several processes that measure
// at once decides for all. Where nothing can be stored, or other work disturbs every measurement, a built-in table serves.

#include <string_view>

namespace asterflow {

struct SumRates {
  double pair = 0.0;  // ns of one pair of a direct sum, targets being sources
  double plan = 0.0;  // time of a fast sum over its prediction
};

// Nanoseconds predicted for a fast sum of n points (mean of sources and targets), given the cost of its plan.
double predicted_fast(double plan_cost, double n);

// Of a Zen 4 core with AVX-512.
SumRates built_in_rates(std::string_view kernel, double accuracy);

// Whether a host could have them, of which others are expected: the ratio of its members decides between sums.
bool are_plausible(SumRates const& rates, SumRates const& expected);

SumRates measured_rates(std::string_view kernel, double accuracy);

// Stored or now measured and stored; built in where that is impossible.
SumRates sum_rates(std::string_view kernel, double accuracy);

}  // namespace asterflow
