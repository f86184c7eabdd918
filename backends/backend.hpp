#pragma once
// The makers of the evaluators of each backend. A new backend adds its maker here and one line to the
// table in evaluator.cpp.

#include "backends/evaluator.hpp"

namespace asterflow {

using Maker = std::unique_ptr<Evaluator>(std::string_view kernel, EvaluatorOptions const& options);

Maker make_reference;
Maker make_direct;  // the best of those below
Maker make_direct_portable, make_direct_avx2, make_direct_avx512;
Maker make_fast;  // the best of those below
Maker make_fast_portable, make_fast_avx2, make_fast_avx512;
Maker make_fast_device;  // in the default execution space
Maker make_automatic;  // direct or fast

// Whether this build and this machine can run the loops of an instruction set.
bool has_avx2();
bool has_avx512();

// What the pair loops of an instruction set ("avx2", "avx512") do for an accuracy where the points allow: for
// benchmarks that count instructions.
struct PairArithmetic {
  int bits = 64;       // of a number
  int steps = 0;       // terms that correct the hardware estimate of 1 / |r|
  int lanes = 0;       // pairs per vector register
  double error = 0.0;  // bound of the relative error of 1 / |r|, rounding apart
};
PairArithmetic pair_arithmetic(std::string_view instructions, std::string_view kernel, double accuracy);

}  // namespace asterflow
