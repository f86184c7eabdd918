#pragma once
// Implicit time derivative at the new time level from states at the two previous ones,
//   dx/dt = (a0 x_new - a1 x_now - a2 x_before) / dt,
// exact for polynomials of degree 1 (backward Euler) or 2 (BDF2 with variable step).
// [Hairer, Norsett & Wanner, Solving ODEs I, sec. III.5]

namespace asterflow {

struct TimeScheme {
  double dt;  // s
  double a0, a1, a2;
};

inline TimeScheme backward_euler(double dt) { return {dt, 1.0, 1.0, 0.0}; }

inline TimeScheme second_order_scheme(double dt, double dt_before) {
  double const w = dt / dt_before;
  return {dt, (1 + 2 * w) / (1 + w), 1 + w, -w * w / (1 + w)};
}

// A velocity that jumps by V after the share s of a step is taken up late by a scheme that extrapolates: right at the end
// of the step, and after the next, if this one has the velocity late_share (1 - s) V besides the mean (1 - s) V, and the next
// one late_share s V besides V, each with its own share (equal steps: 1 / 2; the past as if V had acted always).
inline double late_share(TimeScheme const& scheme) { return scheme.a0 - 1; }

// The fraction of (corrector - predictor) that is the local error of the second-order scheme, when the predictor
// extrapolates the states at t, t - dt_1 and t - dt_1 - dt_2 quadratically (Milne's device).
inline double milne_factor(double dt, double dt_1, double dt_2) {
  double const a0 = second_order_scheme(dt, dt_1).a0;
  return dt / (dt + a0 * (dt + dt_1 + dt_2));
}

}  // namespace asterflow
