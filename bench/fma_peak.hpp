#pragma once
// The machine's rate of fused multiply-adds on vector registers, all threads together: the unit in which pair
// sums are judged.

#include <string_view>

namespace asterflow {

// Instructions per CPU second of one thread, best of several; 0 when this processor lacks the instruction set
// ("avx2", "avx512"). `bits` is 32 or 64. Every thread works at the same time, as in a sum.
double fma_per_second(std::string_view instructions, int bits);

}  // namespace asterflow
