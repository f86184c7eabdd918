// The pair kernels in Fourier space: velocity of a plane wave of strengths with wave vector k, divided by
// s = (filter / k^4). From the derivatives of the biharmonic function in fast_split.hpp, grad -> i k:
//   Stokeslet  k^2 f - k (k.f)
//   rotlet     (k^2 / 2) i k x t
//   stresslet  i (k^2 (2 S k + tr(S) k) - 2 k (k.S k)),  S = (q n + n q) / 2 as xx yy zz xy xz yz
//   pressures, as x components:  -i k^2 (k.f)  and  2 k^2 (k.S k)
// P is a number or a vector; strengths and velocities are (real, imaginary) arrays.

#include <Kokkos_Macros.hpp>

namespace asterflow {
namespace {

struct StokesletSymbol {
  static constexpr int components = 3;
  template <class P>
  KOKKOS_INLINE_FUNCTION static void apply(P const (&k)[3], P s, P const* re, P const* im, P* u_re, P* u_im) {
    P const k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
    P const along_re = k[0] * re[0] + k[1] * re[1] + k[2] * re[2];
    P const along_im = k[0] * im[0] + k[1] * im[1] + k[2] * im[2];
    for (int d = 0; d < 3; ++d) {
      u_re[d] = s * (k2 * re[d] - k[d] * along_re);
      u_im[d] = s * (k2 * im[d] - k[d] * along_im);
    }
  }
};

struct RotletSymbol {
  static constexpr int components = 3;
  template <class P>
  KOKKOS_INLINE_FUNCTION static void apply(P const (&k)[3], P s, P const* re, P const* im, P* u_re, P* u_im) {
    P const half = s * (k[0] * k[0] + k[1] * k[1] + k[2] * k[2]) * 0.5f;
    for (int d = 0; d < 3; ++d) {
      int const a = (d + 1) % 3, b = (d + 2) % 3;
      u_re[d] = -half * (k[a] * im[b] - k[b] * im[a]);
      u_im[d] = half * (k[a] * re[b] - k[b] * re[a]);
    }
  }
};

struct StressletSymbol {
  static constexpr int components = 6;
  template <class P>
  KOKKOS_INLINE_FUNCTION static void contract(P const (&k)[3], P k2, P const* m, P* v) {
    P const by_x = m[0] * k[0] + m[3] * k[1] + m[4] * k[2];
    P const by_y = m[3] * k[0] + m[1] * k[1] + m[5] * k[2];
    P const by_z = m[4] * k[0] + m[5] * k[1] + m[2] * k[2];
    P const trace = k2 * (m[0] + m[1] + m[2]) - 2.0f * (k[0] * by_x + k[1] * by_y + k[2] * by_z);
    P const twice = k2 + k2;
    v[0] = twice * by_x + trace * k[0];
    v[1] = twice * by_y + trace * k[1];
    v[2] = twice * by_z + trace * k[2];
  }
  template <class P>
  KOKKOS_INLINE_FUNCTION static void apply(P const (&k)[3], P s, P const* re, P const* im, P* u_re, P* u_im) {
    P const k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
    P v_re[3], v_im[3];
    contract(k, k2, re, v_re);
    contract(k, k2, im, v_im);
    for (int d = 0; d < 3; ++d) {
      u_re[d] = -s * v_im[d];
      u_im[d] = s * v_re[d];
    }
  }
};

struct StokesletPressureSymbol {
  static constexpr int components = 3;
  template <class P>
  KOKKOS_INLINE_FUNCTION static void apply(P const (&k)[3], P s, P const* re, P const* im, P* p_re, P* p_im) {
    P const factor = s * (k[0] * k[0] + k[1] * k[1] + k[2] * k[2]);
    p_re[0] = factor * (k[0] * im[0] + k[1] * im[1] + k[2] * im[2]);
    p_im[0] = -factor * (k[0] * re[0] + k[1] * re[1] + k[2] * re[2]);
  }
};

struct StressletPressureSymbol {
  static constexpr int components = 6;
  template <class P>
  KOKKOS_INLINE_FUNCTION static P along(P const (&k)[3], P const* m) {
    P const mixed = k[0] * (k[1] * m[3] + k[2] * m[4]) + k[1] * k[2] * m[5];
    return k[0] * k[0] * m[0] + k[1] * k[1] * m[1] + k[2] * k[2] * m[2] + (mixed + mixed);
  }
  template <class P>
  KOKKOS_INLINE_FUNCTION static void apply(P const (&k)[3], P s, P const* re, P const* im, P* p_re, P* p_im) {
    P const factor = s * (k[0] * k[0] + k[1] * k[1] + k[2] * k[2]) * 2.0f;
    p_re[0] = factor * along(k, re);
    p_im[0] = factor * along(k, im);
  }
};

}  // namespace
}  // namespace asterflow
