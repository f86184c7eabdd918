#pragma once
// What curvature adds to the image of a point force behind a wall (plane_image.hpp), to first order. The wall lies at the
// height z_w = (k_1 x^2 + k_2 y^2) / 2 above its tangent plane at the foot of the force, towards the fluid; x, y along its
// principal directions. Force and plane image leave 12 d z_w rho (rho . f - d f_z) / R_0^5 there (8 pi x, viscosity 1),
// rho = (x, y), R_0^2 = rho^2 + d^2. The flow that takes this back from the tangent plane is
//   u = G - z grad chi,   d chi / dz = div G,   G tangential;  G, chi harmonic in Z = z + d > 0.
// In complex notation (x + i y, f = f_x + i f_y), R^2 = rho^2 + Z^2, W = (x + i y) / (R + Z), G and chi are sums of
//   F_q^m = W^m N_q^m(Z / R) / R^(q + 1) = e^{i m phi} int_0^inf k^q e^{-k Z} J_m(k rho) dk,
//   N_0 = 1,  N_1 = m + c,  N_2 = m^2 - 1 + 3 m c + 3 c^2,  N_3 = m^3 - 4 m + (6 m^2 - 9) c + 15 m c^2 + 15 c^3.
// It is singular on the normal behind the image only: meant for a cell whose normals do not meet it again.

#include "base/lanes.hpp"
#include "surface/local_geometry.hpp"

namespace asterflow {

template <class Real>
class CurvatureImage {
 public:
  // foot: the point of the wall closest to the force.
  CurvatureImage(Vec3d force, Vec3d foot, Vec3d normal, double distance, LocalGeometry const& wall)
      : foot_(to_real(foot)), e_1_(to_real(wall.tangent[0])), e_2_(to_real(wall.tangent[1])), e_(to_real(normal)),
        d_(Real(distance)) {
    double const mean = 0.5 * (wall.curvature[0] + wall.curvature[1]), half = 0.5 * (wall.curvature[0] - wall.curvature[1]);
    double const f_1 = asterflow::dot(force, wall.tangent[0]), f_2 = asterflow::dot(force, wall.tangent[1]);
    double const f_e = asterflow::dot(force, normal);
    a_[0] = Real(-1.5 * distance * (2.0 * mean + half) * f_1), a_[1] = Real(1.5 * distance * (2.0 * mean - half) * f_2);
    b_[0] = Real(-1.5 * distance * half * f_1), b_[1] = Real(1.5 * distance * half * f_2);
    h_ = Real(6.0 * distance * mean * f_e), k_ = Real(3.0 * distance * half * f_e);
  }

  // u += 8 pi x flow at x.
  void add(LanesOfVectors<Real> const& x, LanesOfVectors<Real>& u) const {
    LanesOfVectors<Real> const r{x.x - foot_.x, x.y - foot_.y, x.z - foot_.z};
    Lanes<Real> const r_1 = asterflow::dot(e_1_, r), r_2 = asterflow::dot(e_2_, r), z = asterflow::dot(e_, r), Z = z + d_;
    Lanes<Real> const s = (r_1 * r_1 + r_2 * r_2 + Z * Z).rsqrt(), c = Z * s, g = Real(1) + c, t = d_ * s, zs = z * s;
    Lanes<Real> const inverse = s / g;
    Complex const W{r_1 * inverse, r_2 * inverse}, W2 = W * W, W3 = W2 * W, W4 = W2 * W2;
    constexpr Real third = Real(1) / Real(3);
    Lanes<Real> const c2 = c * c, g2 = g * g, c_g2 = c * g2;
    // T, S: of G over s W^m; N2, N3: N_2^m, N_3^m; Q, R0, V: of the derivatives of chi over s^2 W^m.
    Lanes<Real> const T0 = Real(1) - t * (Real(5) * third * c + t * (third - c2)), T2 = Real(1) + t * (Real(1) + g - t * g2),
                      T4 = Real(1) + t * (Real(4) + c + t * (Real(5) + c * (Real(4) + c)));
    Lanes<Real> const S1 = t * g * (Real(1) - t * c), S3 = t * third * (Real(3) + c + t * (Real(8) + Real(3) * c * (Real(3) + c)));
    Lanes<Real> const N2_0 = Real(3) * c2 - Real(1), N2_1 = Real(3) * c * g, N2_3 = Real(8) + Real(3) * c * (Real(3) + c);
    Lanes<Real> const N3_0 = c * (Real(15) * c2 - Real(9)), N3_1 = (Real(15) * c2 - Real(3)) * g;
    Lanes<Real> const N3_4 = Real(48) + c * (Real(87) + c * (Real(60) + Real(15) * c)), N3_3 = Real(15) * g * g2;
    Lanes<Real> const w = Real(2) * third * t, w_t = w * t;
    Lanes<Real> const Q1_0 = w * (t * N3_0 - Real(4) * N2_0), Q1_1 = w * (t * N3_1 - Real(4) * N2_1),
                      Q1_2 = w * g2 * (Real(15) * t * c - Real(12));
    Lanes<Real> const Q3_2 = -Real(15) * w_t * c_g2, Q3_3 = -w_t * N3_3, Q3_4 = -w_t * N3_4;
    Lanes<Real> const R0_0 = t * (N2_0 - third * t * N3_0), R0_1 = t * (N2_1 - third * t * N3_1);
    Lanes<Real> const V1 = w * (N2_1 - t * N3_1), V2 = w * g2 * (Real(3) - Real(15) * t * c), V3 = w * (N2_3 - t * N3_3);
    Complex const aW2 = a_times(W2), bW2 = b_times(W2), bW4 = b_times(W4);
    Lanes<Real> const half_z = Real(0.5) * zs;
    // (x, y) components over s
    Lanes<Real> u_1 = aW2.re * (T2 + half_z * Q1_2) + a_[0] * (T0 - half_z * Q1_0) + bW4.re * (T4 + half_z * Q3_4) +
                      bW2.re * (T2 - half_z * Q3_2);
    Lanes<Real> u_2 = aW2.im * (T2 + half_z * Q1_2) - a_[1] * (T0 - half_z * Q1_0) + bW4.im * (T4 + half_z * Q3_4) -
                      bW2.im * (T2 - half_z * Q3_2);
    Lanes<Real> const with_h = h_ * (S1 - zs * R0_1), with_k = k_ * (S1 - half_z * V1), with_k3 = k_ * (S3 + half_z * V3);
    u_1 += W.re * (with_h + with_k) + W3.re * with_k3;
    u_2 += W.im * (with_h - with_k) + W3.im * with_k3;
    Lanes<Real> const u_e = zs * ((a_[0] * W.re - a_[1] * W.im) * Q1_1 + (b_[0] * W3.re - b_[1] * W3.im) * Q3_3 -
                                  h_ * R0_0 + k_ * W2.re * V2);
    u.x += s * (e_1_.x * u_1 + e_2_.x * u_2 + e_.x * u_e);
    u.y += s * (e_1_.y * u_1 + e_2_.y * u_2 + e_.y * u_e);
    u.z += s * (e_1_.z * u_1 + e_2_.z * u_2 + e_.z * u_e);
  }

 private:
  struct Complex {
    Lanes<Real> re, im;
    friend Complex operator*(Complex const& a, Complex const& b) {
      return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
  };
  static Vec3<Real> to_real(Vec3d v) { return {Real(v.x), Real(v.y), Real(v.z)}; }
  Complex a_times(Complex const& w) const { return {a_[0] * w.re - a_[1] * w.im, a_[0] * w.im + a_[1] * w.re}; }
  Complex b_times(Complex const& w) const { return {b_[0] * w.re - b_[1] * w.im, b_[0] * w.im + b_[1] * w.re}; }

  Vec3<Real> foot_, e_1_, e_2_, e_;
  Real d_;
  Real a_[2], b_[2];  // real and imaginary part
  Real h_, k_;
};

}  // namespace asterflow
