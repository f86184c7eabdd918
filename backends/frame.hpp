#pragma once
// Coordinates as the pair loops want them: moved and scaled so that neither 1e-8 nor 1e8 units lead out of
// the range of the arithmetic. Doubles are scaled by a power of two but not moved, so differences are those
// of the given points, bit by bit. In float arithmetic a coordinate is the sum of two floats (six numbers
// xh yh zh xl yl zl per point), and a difference is (xh - yh) + (xl - yl): each term is exact or rounded relative to
// itself, so points that nearly touch keep single precision down to closest_in_float.

#include "backends/point_cloud.hpp"

#include <cmath>

namespace asterflow {

// Largest relative error of one pair in float arithmetic, rounding alone (measured: 5e-7).
inline constexpr double float_rounding = 7e-7;

// Distance over extent of the cloud that two floats per coordinate still resolve to single precision: they resolve
// 2^-49 of the extent. Clouds with closer pairs (coincident points apart) are summed in double.
inline constexpr double closest_in_float = 0x1p-25;

inline bool is_too_close_for_float(ConstPoints sources, ConstPoints targets, Bounds const& box) {
  return has_close_pair(sources, targets, closest_in_float * box.extent());
}

template <class Real>
inline constexpr int n_coordinates = sizeof(Real) == 4 ? 6 : 3;

struct Frame {
  Vec3d origin{};
  double scale = 1.0;
};

// Scaled extents are below 2^12 in float: fifth powers of distances and their inverses stay within its range.
// Below 2^61 in double: squares stay within the range of a float, from which AVX2 starts.
template <class Real>
Frame frame_of(Bounds const& box) {
  int const exponent = sizeof(Real) == 4 ? 11 : 60;
  double const extent = box.extent();
  return {sizeof(Real) == 4 ? box.centre() : Vec3d{}, extent > 0.0 ? std::exp2(exponent - std::ilogb(extent)) : 1.0};
}

template <class Real>
void put(Real* out, long stride, Vec3d x) {
  for (int c = 0; c < 3; ++c) out[c * stride] = static_cast<Real>(x[c]);
}

// Writes the coordinates of one point with `stride` numbers between them.
template <class Real>
void put_coordinates(Real* out, long stride, Vec3d x, Frame const& frame) {
  Vec3d const a = frame.scale * (x - frame.origin);
  if constexpr (n_coordinates<Real> == 3) {
    put(out, stride, a);
  } else {
    // Adding and taking away rounds to multiples of 2^-12, which fit in a float up to 2^12. (A round trip
    // through float would do, but g++ 12 optimises it away when it vectorises.)
    Vec3d const shift{0x1.8p40, 0x1.8p40, 0x1.8p40};
    Vec3d const high = (a + shift) - shift;
    put(out, stride, high);
    put(out + 3 * stride, stride, a - high);
  }
}

// Power of two near the largest strength; strengths divided by it are in the range of float.
inline double strength_unit(ConstPoints strengths) {
  double largest = 0.0;
  for (Vec3d const& q : strengths) largest = std::max({largest, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  constexpr int least = -1022;  // of the normal numbers, whose inverses are finite
  return largest > 0.0 && std::isfinite(largest) ? std::exp2(std::max(std::ilogb(largest), least)) : 1.0;
}

}  // namespace asterflow
