#pragma once
// Loops over many small independent pieces, handed to the threads in blocks.

#include "base/parallel.hpp"

#include <algorithm>

namespace asterflow {

// body(i) for i in [0, n).
template <class Body>
void for_blocks(char const* label, long n, Body const& body) {
  constexpr long block = 2048;
  parallel_for(label, (n + block - 1) / block, [&](long i_block) {
    for (long i = i_block * block; i < std::min(n, (i_block + 1) * block); ++i) body(i);
  });
}

}  // namespace asterflow
