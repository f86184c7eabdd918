#include "system/own_sums.hpp"

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"
#include "system/stokeslet_lanes.hpp"

#include <algorithm>

namespace asterflow {

void subtract_own_sums(ConstPoints positions, std::vector<std::size_t> const& first, ConstPoints strengths, Points velocity) {
  constexpr long lanes = n_lane<double>;
  parallel_for("subtract_own_sums", static_cast<long>(first.size()) - 1, [&](long fiber) {
    std::size_t const begin = first[fiber], end = first[fiber + 1];
    for (auto i = static_cast<long>(begin); i < static_cast<long>(end); i += lanes) {
      long const count = std::min(lanes, static_cast<long>(end) - i);
      auto const x = gather<double>(positions, i, count);
      LanesOfVectors<double> u;
      for (std::size_t j = begin; j < end; ++j) add_stokeslet(x, positions[j], strengths[j], u);
      add_lanes(-Stokeslet::prefactor, u, i, count, velocity);
    }
  });
}

}  // namespace asterflow
