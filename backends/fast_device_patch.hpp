#pragma once
// A patch of the far field as the kernels for any execution space see it: plain numbers, tables as positions in arrays
// that all patches share. Grids are [component, z, y, x]; spectra (complex) [component, z, y, kx].

#include "backends/fast_device_space.hpp"
#include "backends/fast_patches.hpp"

namespace asterflow {

inline constexpr int block_edge = 8;  // nodes of a block in each direction; the last of a row may have fewer

// A one-dimensional transform, see fast_fourier.hpp.
struct DeviceLine {
  static constexpr int max_radices = 24;
  int length = 0, n_radix = 0, radices[max_radices] = {};
  long twiddles = 0;  // position of its first
};

struct DevicePatch {
  int nodes[3], blocks[3], modes[3], target_low[3], target_high[3];
  double corner[3], to_nodes, scale, slope_scale;
  long source_begin;  // position of its first block in the table of first sources
  long target_begin, n_target;
  long symbol;        // position of its table
  DeviceLine lines[3];
  long grid, spectrum;  // positions of its working memory

  KOKKOS_INLINE_FUNCTION long n_node() const { return static_cast<long>(nodes[0]) * nodes[1] * nodes[2]; }
  KOKKOS_INLINE_FUNCTION int n_kx() const { return modes[0] + 1; }
  KOKKOS_INLINE_FUNCTION long n_mode() const { return static_cast<long>(n_kx()) * nodes[1] * nodes[2]; }
  KOKKOS_INLINE_FUNCTION long n_block() const { return static_cast<long>(blocks[0]) * blocks[1] * blocks[2]; }

  // First node of a point's window in direction d, from 0; z: where the point lies between nodes, as the window's
  // polynomials want it.
  template <class Real>
  KOKKOS_INLINE_FUNCTION int first_node(double x, int d, Real& z) const {
    double const xi = (x - corner[d]) * to_nodes;
    int const first = static_cast<int>(floor(xi));
    z = static_cast<Real>(2.0 * (first - xi) + 1.0);
    return wrapped_node(first, nodes[d]);
  }
};

// The window's polynomials.
template <class Real>
struct DeviceWindow {
  int width, padded, degree;
  DeviceArray<Real> coefficients;

  // Weight of node j of a window, or its slope.
  KOKKOS_INLINE_FUNCTION Real weight(int j, Real z, bool is_slope) const {
    Real const* const c = &coefficients((is_slope ? (degree + 1) * padded : 0) + j);
    Real sum = c[degree * padded];
    for (int k = degree - 1; k >= 0; --k) sum = sum * z + c[k * padded];
    return sum;
  }
};

// Everything the kernels read: made once per geometry, but for the strengths.
template <class Real>
struct DeviceTables {
  DeviceWindow<Real> window;
  DeviceArray<DevicePatch> patches;
  DeviceArray<long> first_sources;        // [blocks of all patches, and one per patch]
  DeviceArray<std::uint32_t> sources, targets;  // of the patches, by block
  DeviceArray<Real> symbols, twiddles;
  DeviceArray<double> source_points, target_points;  // [n, 3]
  DeviceArray<Real> strengths;                       // [n_source, components]
  DeviceArray<Real> grid, spectrum;
};

// Work on the patches first ... first + n - 1 in equal pieces: patch i has begin(i) ... begin(i + 1) - 1.
struct DevicePieces {
  int first = 0, n = 0;
  long total = 0;
  DeviceArray<long> begin;

  // The patch of piece k, whose number within the patch replaces k.
  KOKKOS_INLINE_FUNCTION int patch_of(long& k) const {
    int const i = piece_of(begin.data(), n, k);
    k -= begin(i);
    return first + i;
  }
};

}  // namespace asterflow
