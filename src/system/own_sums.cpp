#include "system/own_sums.hpp"

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"
#include "system/stokeslet_lanes.hpp"

#include <algorithm>

namespace asterflow {
namespace {

template <class Real>
Vec3<Real> as(Vec3d v) {
  return {Real(v.x), Real(v.y), Real(v.z)};
}

}  // namespace

template <class Real>
void subtract_own_sums(ConstPoints positions, std::vector<std::size_t> const& first, ConstPoints strengths, Points velocity) {
  constexpr long lanes = n_lane<Real>;
  parallel_for("subtract_own_sums", static_cast<long>(first.size()) - 1, [&](long fiber) {
    std::size_t const begin = first[fiber], end = first[fiber + 1];
    if (begin == end) return;
    Vec3d const origin = positions[begin];  // floats hold places on a fiber, not in a cell
    for (auto i = static_cast<long>(begin); i < static_cast<long>(end); i += lanes) {
      long const count = std::min(lanes, static_cast<long>(end) - i);
      auto const x = gather<Real>(positions, i, count, origin);
      LanesOfVectors<Real> u;
      for (std::size_t j = begin; j < end; ++j)
        add_stokeslet(x, as<Real>(positions[j] - origin), as<Real>(strengths[j]), u);
      add_lanes(-Stokeslet::prefactor, u, i, count, velocity);
    }
  });
}

template void subtract_own_sums<double>(ConstPoints, std::vector<std::size_t> const&, ConstPoints, Points);
template void subtract_own_sums<float>(ConstPoints, std::vector<std::size_t> const&, ConstPoints, Points);

}  // namespace asterflow
