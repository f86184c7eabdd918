#pragma once
// Stokes flow inside or outside a closed surface with given velocity w on it (zero at infinity), as a precomputed linear
// map: boundary velocity at the surface's nodes -> velocity anywhere, at any distance, on the surface too.
//   interior: data with net flux are met up to a multiple of the normal.
//   exterior: net force and torque on the fluid follow from w (load); forces for viscosity 1.
// All in the surface's own frame, lengths in um. Method: shell_operator.hpp, shell_table.hpp.

#include "surface/shell_operator.hpp"
#include "surface/surface.hpp"

#include <memory>

namespace asterflow {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

class DirichletFlow {
 public:
  // accuracy: relative, of everything but the resolution of w by the surface's nodes.
  DirichletFlow(Surface surface, Side side, double accuracy);

  Surface const& surface() const { return *surface_; }
  Side side() const { return side_; }

  // Fixed targets, ready for repeated evaluation.
  class Targets {
   public:
    std::size_t size() const { return points_.size(); }
    std::size_t memory() const { return sizeof(Point) * points_.capacity(); }  // bytes
    // Interior: those within the surface's copy of that scale about its centre, as targets of the copy, and their places
    // among all; both overwritten.
    void within(double scale, Targets& inside, std::vector<std::size_t>& places) const;

   private:
    friend class DirichletFlow;
    struct Point {
      TablePoint table;
      double factor;  // 1 or, exterior, 1 / rho
    };
    void set_range();
    std::vector<Point> points_;
    PsiRange range_;
  };

  // Targets on the wrong side are moved onto the surface when they are within 1e-3 of its size, else NumericalError.
  Targets plan(ConstPoints targets) const;
  void plan(ConstPoints targets, Targets& result) const;  // reuses memory

  // Calls on one object must not overlap: they share work arrays.
  void add_velocity(ConstPoints boundary_velocity, Targets const& targets, Points velocity) const;
  // The same with a relative error below 1e-3, in single precision: for the inside of a preconditioner.
  void add_rough_velocity(ConstPoints boundary_velocity, Targets const& targets, Points velocity) const;

  // Exterior: force (pN) and torque (pN um) about the origin of the shape's frame on the fluid, viscosity 1.
  Vector6 load(ConstPoints boundary_velocity) const;
  // Exterior: load of the six unit rigid motions (translation, rotation about the origin); symmetric to the grid's accuracy.
  Matrix6 resistance() const;
  std::size_t memory() const;  // bytes

 private:
  // Work space of an evaluation.
  template <class Real>
  struct Evaluation {
    std::vector<ShellMode<Real>> modes;
    ShellTable::Values<Real> values;
  };
  template <class Real>
  void add_interpolated(ShellTable const& table, Evaluation<Real>& work, ConstPoints boundary_velocity,
                        Targets const& targets, Points velocity) const;

  std::unique_ptr<Surface const> surface_;  // the operator refers to it
  Side side_;
  int n_shell_;
  ShellTable table_, rough_table_;
  std::unique_ptr<ShellOperator const> operator_;
  mutable Evaluation<double> work_;
  mutable Evaluation<float> rough_work_;
};

// Grid of that order with as many rings along a long shape as resolve nearby objects at its side like azimuths do: a force at
// 1.5 b costs exp(-0.4 p) across, exp(-p b / (2 a)) along semi-axes a > b with p + 1 rings, so about a / b times as many.
// (Fewer beyond a / b = 1.4, where not everything is that close.)
SphereGrid grid_of_order(Shape const& shape, int order);
// Order whose nodes resolve the flow of objects about a third of the surface's size away to the relative accuracy.
int default_order(Shape const& shape, double accuracy);
// The accuracy that an order stands for in this sense.
double resolved_accuracy(Shape const& shape, int order);

}  // namespace asterflow
