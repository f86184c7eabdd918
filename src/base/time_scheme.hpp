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

// A velocity that jumps by V within a step is taken up late: what follows stays behind by delay x dt x V (equal steps: dt V / 2),
// unless the step moves by that much more.
inline double delay(TimeScheme const& scheme) { return (scheme.a1 - 1) / scheme.a1; }

// The fraction of (corrector - predictor) that is the local error of the second-order scheme, when the predictor
// extrapolates the states at t, t - dt_1 and t - dt_1 - dt_2 quadratically (Milne's device).
inline double milne_factor(double dt, double dt_1, double dt_2) {
  double const a0 = second_order_scheme(dt, dt_1).a0;
  return dt / (dt + a0 * (dt + dt_1 + dt_2));
}

}  // namespace asterflow
