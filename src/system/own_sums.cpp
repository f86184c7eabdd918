#include "system/own_sums.hpp"

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace asterflow {
namespace {

// As many targets as fill a vector register are summed at once.
constexpr std::size_t n_lane = 8;
using Lanes = Eigen::Array<double, n_lane, 1>;

// The targets first ... first + count - 1 of one fiber.
void subtract(ConstPoints positions, ConstPoints strengths, std::size_t first, std::size_t count, Points velocity) {
  Lanes x = Lanes::Zero(), y = x, z = x, ux = x, uy = x, uz = x;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d const target = positions[first + i];
    x[i] = target.x, y[i] = target.y, z[i] = target.z;
  }
  for (std::size_t j = 0; j < positions.size(); ++j) {
    Vec3d const source = positions[j], f = strengths[j];
    Lanes const rx = x - source.x, ry = y - source.y, rz = z - source.z, r2 = rx * rx + ry * ry + rz * rz;
    Lanes const s = (r2 > 0.0).select(r2.sqrt().inverse(), 0.0);
    Lanes const along = s * s * s * (f.x * rx + f.y * ry + f.z * rz);
    ux += s * f.x + along * rx;
    uy += s * f.y + along * ry;
    uz += s * f.z + along * rz;
  }
  for (std::size_t i = 0; i < count; ++i) velocity[first + i] -= Stokeslet::prefactor * Vec3d{ux[i], uy[i], uz[i]};
}

}  // namespace

void subtract_own_sums(ConstPoints positions, std::vector<std::size_t> const& first, ConstPoints strengths, Points velocity) {
  parallel_for("subtract_own_sums", static_cast<long>(first.size()) - 1, [&](long fiber) {
    std::size_t const begin = first[fiber], n = first[fiber + 1] - begin;
    for (std::size_t i = 0; i < n; i += n_lane)
      subtract(positions.subspan(begin, n), strengths.subspan(begin, n), i, std::min(n_lane, n - i),
               velocity.subspan(begin, n));
  });
}

}  // namespace asterflow
