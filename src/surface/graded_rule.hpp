#pragma once
// One-dimensional quadrature for smooth functions that are nearly singular at one point: singularities at a complex
// distance `scale` of `centre`. Each side is split where the oscillation of the density dominates; the inner part is
// stretched by x = centre + scale sinh(t), whose Gauss-Legendre error falls geometrically at any scale
// [Johnston & Elliott 2005]; an inner part with scale 0 resolves an integrable singularity to 1e-13 of its length.

#include <vector>

namespace asterflow {

struct RulePoint {
  double x, weight;
};

struct GradedRuleOptions {
  double digits = 10.0;     // decimal digits wanted
  double wavenumber = 16.0; // the density oscillates at most like cos(wavenumber x)
};

// Appends a rule for [first, last], first <= centre <= last.
void append_graded_rule(double first, double centre, double last, double scale, GradedRuleOptions const& options,
                        std::vector<RulePoint>& rule);

// Overwrites `rule` by one for the whole period [centre - pi, centre + pi) of a periodic function that is singular at
// centre + i delta: the trapezoid rule where that is cheap, else a graded one.
void periodic_rule(double centre, double delta, GradedRuleOptions const& options, std::vector<RulePoint>& rule);

// Overwrites `rule` by one on the half period [0, pi] of an even function that is singular at i delta, with the weights of
// the whole period.
void half_period_rule(double delta, GradedRuleOptions const& options, std::vector<RulePoint>& rule);

}  // namespace asterflow
