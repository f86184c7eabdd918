#pragma once
// The flow of a fiber along itself beyond its local drag: the finite part of slender-body theory
// [Keller & Rubinow 1976; Johnson 1980; Tornberg & Shelley 2004, Eqs. 5-7],
//   u(s) = (1 / 8 pi mu) { 2 (I - t t) f(s) + int [ (I + R R) / |R| f(s') - (I + t t) / |s - s'| f(s) ] ds' },
// R = X(s) - X(s') (R R of its direction), t = X_s. Together with c (I + t t) f it is the motion of a slender spheroid
// of radius `radius` to O(eps^2 log eps). With the smooth g(s') = |s - s'| (I + R R) / |R| f(s') the integral is
// int (g(s') - g(s)) / |s - s'| ds', which is diagonal on Legendre polynomials:
//   P_k -> -2 H_k P_k,  H_k = 1 + 1/2 + ... + 1/k                       [Goetz 2000, thesis, Kaiserslautern].
// The theory ends with modes as short as the radius: there 2 H_k would exceed ln(eps^-2 e^-1) and the fiber would move
// against its force. So 2 H_k is held one below that.

#include "base/arrays.hpp"
#include "fiber/fiber_basis.hpp"

namespace asterflow {

struct Centreline;

class OwnFlow {
 public:
  // nodes [n_node] um: those of the shape. mobility: c, um^2 / (pN s).
  void prepare(FiberBasis const& basis, Centreline const& shape, ConstPoints nodes, double mobility, double viscosity);

  // u += flow (um/s) of the force density f (pN/um) on the fluid, both [n_node].
  void add(ConstPoints f, Points u) const;

  std::size_t memory() const { return sizeof(double) * static_cast<std::size_t>(matrix_.size()); }  // bytes

 private:
  Eigen::MatrixXd matrix_;  // [3 n_node, 3 n_node] um^2 / (pN s)
};

}  // namespace asterflow
