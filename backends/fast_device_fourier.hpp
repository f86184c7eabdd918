#pragma once
// The sweeps of a patch's convolution as kernels for any execution space: lines along x (real rows in pairs), y and z,
// each transformed by a team in its scratch memory, and the kernel's symbol between. Only modes inside the band are kept.

#include "backends/fast_device_patch.hpp"

#include "backends/fast_butterfly.inl"

namespace asterflow {

inline constexpr int lines_per_team = 4;

// A line of complex numbers per lane, [node, lines_per_team], real and imaginary parts apart, and room of the same size.
template <class Real>
struct DeviceLines {
  Real *re, *im, *work_re, *work_im;

  KOKKOS_FUNCTION DeviceLines(Real* memory, int length)
      : re(memory), im(re + length * lines_per_team), work_re(im + length * lines_per_team), work_im(work_re + length * lines_per_team) {}
  KOKKOS_FUNCTION static long numbers(int length) { return 4L * length * lines_per_team; }

  KOKKOS_FUNCTION void exchange() {
    Real* const r = re;
    re = work_re;
    work_re = r;
    Real* const i = im;
    im = work_im;
    work_im = i;
  }

  // re + i im becomes its transform, without scale; the inverse is the same with re and im exchanged.
  KOKKOS_FUNCTION void transform(DeviceTeam const& team, DeviceLine const& line, Real const* twiddles) {
    int n = line.length, s = lines_per_team;
    Real const* w = twiddles + line.twiddles;
    for (int i = 0; i < line.n_radix; ++i) {
      int const radix = line.radices[i], m = n / radix;
      Real *const xr = re, *const xi = im, *const yr = work_re, *const yi = work_im;
      team.team_barrier();
      Kokkos::parallel_for(Kokkos::TeamThreadRange(team, m * s), [&](int k) {
        int const p = k / s, q = k % s;
        Real const* const v = w + 2 * (radix - 1) * p;
        if (radix == 4) return line_group<Real, 4>(xr, xi, yr, yi, m, s, p, q, v);
        if (radix == 2) return line_group<Real, 2>(xr, xi, yr, yi, m, s, p, q, v);
        if (radix == 3) return line_group<Real, 3>(xr, xi, yr, yi, m, s, p, q, v);
        line_group<Real, 5>(xr, xi, yr, yi, m, s, p, q, v);
      });
      exchange();
      w += 2 * (radix - 1) * m;
      n = m;
      s *= radix;
    }
    team.team_barrier();
  }
  KOKKOS_FUNCTION void transform_back(DeviceTeam const& team, DeviceLine const& line, Real const* twiddles) {
    DeviceLines other = *this;
    other.re = im, other.im = re, other.work_re = work_im, other.work_im = work_re;
    other.transform(team, line, twiddles);
    re = other.im, im = other.re, work_re = other.work_im, work_im = other.work_re;
  }
};

// Rows y and y + 1 of a grid as real and imaginary part of one line, lines_per_team such pairs at once.
template <class Real, bool inverse>
struct DeviceRows {
  DeviceTables<Real> tables;
  DevicePieces pieces;  // [component, z, group of pairs]
  int level;            // of scratch memory

  static long count(DevicePatch const& patch, int components) {
    long const planes = inverse ? patch.target_high[2] - patch.target_low[2] : patch.nodes[2];
    return components * planes * ((patch.nodes[1] / 2 + lines_per_team - 1) / lines_per_team);
  }

  KOKKOS_FUNCTION void operator()(DeviceTeam const& team) const {
    long k = team.league_rank();
    DevicePatch const& patch = tables.patches(pieces.patch_of(k));
    int const nx = patch.nodes[0], n_pair = patch.nodes[1] / 2, n_group = (n_pair + lines_per_team - 1) / lines_per_team;
    int const planes = inverse ? patch.target_high[2] - patch.target_low[2] : patch.nodes[2];
    int const pair = static_cast<int>(k % n_group) * lines_per_team, n = n_pair - pair < lines_per_team ? n_pair - pair : lines_per_team;
    long const c = k / n_group / planes, z = k / n_group % planes + (inverse ? patch.target_low[2] : 0);
    long const row = (c * patch.nodes[2] + z) * patch.nodes[1] + 2 * pair;  // its first
    Real* const grid = &tables.grid(patch.grid) + row * nx;
    Real* const spectrum = &tables.spectrum(2 * patch.spectrum) + 2 * row * patch.n_kx();
    DeviceScratch<Real> const memory(team.team_scratch(level), DeviceLines<Real>::numbers(nx));
    DeviceLines<Real> lines(memory.data(), nx);
    if constexpr (inverse) {
      join(team, patch, n, spectrum, lines);
      lines.transform_back(team, patch.lines[0], tables.twiddles.data());
      Kokkos::parallel_for(Kokkos::TeamThreadRange(team, n * nx), [&](int i) {
        int const l = i / nx, x = i % nx;
        grid[2 * l * nx + x] = lines.re[x * lines_per_team + l];
        grid[(2 * l + 1) * nx + x] = lines.im[x * lines_per_team + l];
      });
    } else {
      Kokkos::parallel_for(Kokkos::TeamThreadRange(team, lines_per_team * nx), [&](int i) {
        int const l = i / nx, x = i % nx;
        lines.re[x * lines_per_team + l] = l < n ? grid[2 * l * nx + x] : Real(0);
        lines.im[x * lines_per_team + l] = l < n ? grid[(2 * l + 1) * nx + x] : Real(0);
      });
      lines.transform(team, patch.lines[0], tables.twiddles.data());
      separate(team, patch, n, lines, spectrum);
    }
  }

  // Twice the transforms of the two rows, from that of their sum; the symbol has the half.
  KOKKOS_FUNCTION void separate(DeviceTeam const& team, DevicePatch const& patch, int n, DeviceLines<Real> const& lines,
                                Real* spectrum) const {
    int const nx = patch.nodes[0], n_kx = patch.n_kx();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, n * n_kx), [&](int i) {
      int const l = i / n_kx, kx = i % n_kx;
      int const a = kx * lines_per_team + l, b = (kx == 0 ? 0 : nx - kx) * lines_per_team + l;
      Real* const first = spectrum + 2 * (2L * l * n_kx + kx);
      Real* const second = first + 2 * n_kx;
      first[0] = lines.re[a] + lines.re[b];
      first[1] = lines.im[a] - lines.im[b];
      second[0] = lines.im[a] + lines.im[b];
      second[1] = lines.re[b] - lines.re[a];
    });
  }

  KOKKOS_FUNCTION void join(DeviceTeam const& team, DevicePatch const& patch, int n, Real const* spectrum,
                            DeviceLines<Real> const& lines) const {
    int const nx = patch.nodes[0], n_kx = patch.n_kx();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, lines_per_team * nx), [&](int i) {
      int const l = i / nx, x = i % nx, kx = x < nx - x ? x : nx - x, at = x * lines_per_team + l;
      Real const sign = x <= nx - x ? Real(1) : Real(-1);
      bool const is_kept = l < n && kx < n_kx;
      Real const* const first = spectrum + 2 * (2L * l * n_kx + kx);
      Real const* const second = first + 2 * n_kx;
      lines.re[at] = !is_kept ? Real(0) : kx == 0 ? first[0] : first[0] - sign * second[1];
      lines.im[at] = !is_kept ? Real(0) : kx == 0 ? second[0] : second[0] + sign * first[1];
    });
  }
};

// Lines of modes along y (axis 1) or z (axis 2), lines_per_team neighbours in kx at once.
template <class Real, int axis, bool inverse>
struct DeviceColumns {
  DeviceTables<Real> tables;
  DevicePieces pieces;  // [component, outer, group of kx]
  int level;            // of scratch memory

  // Lines along y: one for every plane z, that is wanted; lines along z: for every mode ky that is kept.
  KOKKOS_FUNCTION static int n_outer(DevicePatch const& patch) {
    if (axis == 2) return 2 * patch.modes[1] + 1;
    return inverse ? patch.target_high[2] - patch.target_low[2] : patch.nodes[2];
  }
  KOKKOS_FUNCTION static int n_group(DevicePatch const& patch) { return (patch.n_kx() + lines_per_team - 1) / lines_per_team; }
  static long count(DevicePatch const& patch, int components) { return static_cast<long>(components) * n_outer(patch) * n_group(patch); }

  KOKKOS_FUNCTION void operator()(DeviceTeam const& team) const {
    long k = team.league_rank();
    DevicePatch const& patch = tables.patches(pieces.patch_of(k));
    int const n_kx = patch.n_kx(), length = patch.nodes[axis], groups = n_group(patch);
    int const kx = static_cast<int>(k % groups) * lines_per_team, n = n_kx - kx < lines_per_team ? n_kx - kx : lines_per_team;
    long const c = k / groups / n_outer(patch);
    int const outer = static_cast<int>(k / groups % n_outer(patch));
    long const y = axis == 2 ? wrapped_node(outer - patch.modes[1], patch.nodes[1]) : 0;
    long const z = axis == 1 ? outer + (inverse ? patch.target_low[2] : 0) : 0;
    long const stride = 2L * n_kx * (axis == 2 ? patch.nodes[1] : 1);
    Real* const base = &tables.spectrum(2 * (patch.spectrum + c * patch.n_mode() + (z * patch.nodes[1] + y) * n_kx + kx));
    DeviceScratch<Real> const memory(team.team_scratch(level), DeviceLines<Real>::numbers(length));
    DeviceLines<Real> lines(memory.data(), length);
    auto const is_mode = [&](int j) { return j <= patch.modes[axis] || j >= length - patch.modes[axis]; };
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, length * lines_per_team), [&](int i) {
      int const j = i / lines_per_team, l = i % lines_per_team;
      bool const is_kept = l < n && (!inverse || is_mode(j));
      lines.re[i] = is_kept ? base[j * stride + 2 * l] : Real(0);
      lines.im[i] = is_kept ? base[j * stride + 2 * l + 1] : Real(0);
    });
    if constexpr (inverse)
      lines.transform_back(team, patch.lines[axis], tables.twiddles.data());
    else
      lines.transform(team, patch.lines[axis], tables.twiddles.data());
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, length * lines_per_team), [&](int i) {
      int const j = i / lines_per_team, l = i % lines_per_team;
      if (l >= n || !(inverse || is_mode(j))) return;
      base[j * stride + 2 * l] = lines.re[i];
      base[j * stride + 2 * l + 1] = lines.im[i];
    });
  }
};

// Multiplies the modes by the symbol of a kernel, in place: Symbol::components strengths become three velocities.
template <class Real, class Symbol>
struct DeviceSymbol {
  DeviceTables<Real> tables;
  DevicePieces modes;  // [jz, jy, jx]

  static long count(DevicePatch const& patch, int) {
    return static_cast<long>(2 * patch.modes[2] + 1) * (2 * patch.modes[1] + 1) * patch.n_kx();
  }

  KOKKOS_FUNCTION void operator()(long i) const {
    DevicePatch const& patch = tables.patches(modes.patch_of(i));
    constexpr double two_pi = 6.283185307179586;
    int const n_kx = patch.n_kx(), n_y = 2 * patch.modes[1] + 1;
    int const j[3] = {static_cast<int>(i % n_kx), static_cast<int>(i / n_kx % n_y) - patch.modes[1],
                      static_cast<int>(i / n_kx / n_y) - patch.modes[2]};
    Real k[3];
    for (int d = 0; d < 3; ++d) k[d] = static_cast<Real>(two_pi * j[d] / patch.nodes[d]);
    long const row = static_cast<long>(j[2] < 0 ? -j[2] : j[2]) * (patch.modes[1] + 1) + (j[1] < 0 ? -j[1] : j[1]);
    Real const s = tables.symbols(patch.symbol + row * n_kx + j[0]);
    long const z = wrapped_node(j[2], patch.nodes[2]), y = wrapped_node(j[1], patch.nodes[1]);
    Real* const mode = &tables.spectrum(2 * (patch.spectrum + (z * patch.nodes[1] + y) * n_kx + j[0]));
    long const stride = 2 * patch.n_mode();
    Real re[Symbol::components], im[Symbol::components], u_re[3] = {}, u_im[3] = {};
    for (int c = 0; c < Symbol::components; ++c) re[c] = mode[c * stride], im[c] = mode[c * stride + 1];
    Symbol::apply(k, s, re, im, u_re, u_im);
    for (int d = 0; d < 3; ++d) mode[d * stride] = u_re[d], mode[d * stride + 1] = u_im[d];
  }
};

}  // namespace asterflow
