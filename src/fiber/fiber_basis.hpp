#pragma once
// Discretisation of one fiber with n hydrodynamic nodes: unit tangents are given at m Legendre-Gauss-Lobatto nodes
// (both ends included), positions are integrals of the interpolated tangent, hydrodynamics and virtual work are
// sampled at n Gauss-Legendre nodes. m is about 3 n / 4, so that products of shapes are not aliased.
// All matrices are for unit length, alpha = s / L in [0, 1].

#include "fiber/legendre.hpp"

namespace asterflow {

inline constexpr int min_fiber_nodes = 6;
inline constexpr int max_fiber_nodes = 64;

struct FiberBasis {
  explicit FiberBasis(int n_node);

  int n_node, n_tangent;
  UnitRule gauss;              // [n_node]    hydrodynamic nodes
  UnitRule lobatto;            // [n_tangent] tangent nodes; the weights integrate a tangent from 0 to 1
  Eigen::MatrixXd tangent;     // [n_node, n_tangent]    values at the tangent nodes -> at the hydrodynamic nodes
  Eigen::MatrixXd position;    // [n_node, n_tangent]    ... -> integral from 0 to the hydrodynamic nodes
  Eigen::MatrixXd derivative;  // [n_node, n_tangent]    ... -> d/d alpha at the hydrodynamic nodes
  Eigen::MatrixXd bending;     // [n_tangent, n_tangent] integral of the product of two derivatives
  Eigen::MatrixXd transform;   // [n_tangent, n_tangent] values -> Legendre coefficients
  Eigen::MatrixXd legendre;    // [n_node, n_node]       values of the Legendre polynomials at the hydrodynamic nodes
  Eigen::MatrixXd remainder;   // [n_node, n_node]       values at the hydrodynamic nodes -> integral from there to 1
  // [n_node, n_node] values g at the hydrodynamic nodes -> weak derivative h: sum w l h = -sum w (dl/d alpha) g for every
  // polynomial l of degree < n_node. h is dg/d alpha with g(0) and -g(1) as points of force at the ends.
  Eigen::MatrixXd weak_derivative;
};

// The basis of that many nodes; made once, kept for ever.
FiberBasis const& fiber_basis(int n_node);

// Nodes for a fiber of that length (um) whose shape varies over `persistence` um (the radius of its sharpest bends, or
// the distance over which the flow around it changes), for a relative error of its shape below `accuracy`.
int default_node_count(double length, double accuracy, double persistence = 5.0);

}  // namespace asterflow
