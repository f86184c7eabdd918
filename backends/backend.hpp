#pragma once
// The makers of the evaluators of each backend. A new backend adds its maker here and one line to the
// table in evaluator.cpp.

#include "backends/evaluator.hpp"

namespace asterflow {

std::unique_ptr<Evaluator> make_reference(std::string_view kernel, double accuracy);
std::unique_ptr<Evaluator> make_direct(std::string_view kernel, double accuracy);  // the best of those below
std::unique_ptr<Evaluator> make_direct_portable(std::string_view kernel, double accuracy);
std::unique_ptr<Evaluator> make_direct_avx2(std::string_view kernel, double accuracy);
std::unique_ptr<Evaluator> make_direct_avx512(std::string_view kernel, double accuracy);

// Whether this build and this machine can run the backend.
bool has_direct_avx2();
bool has_direct_avx512();
std::unique_ptr<Evaluator> make_automatic(std::string_view kernel, double accuracy);  // direct or fast
std::unique_ptr<Evaluator> make_fast(std::string_view kernel, double accuracy);

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
