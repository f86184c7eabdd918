#pragma once
// Fewer nodes for the same fibers: every fiber's nodal values as a polynomial in s / L on its Gauss-Legendre nodes,
// taken to the Gauss-Legendre nodes of a coarser rule and back. For the preconditioner.

#include "base/arrays.hpp"

#include <Eigen/Core>
#include <map>

namespace asterflow {

class FiberCoarsening {
 public:
  // `first` [n_fiber + 1]: where each fiber's nodes begin. A fiber with n nodes gets max(4, n / divisor).
  FiberCoarsening(std::vector<std::size_t> first, int divisor);

  std::size_t size() const { return coarse_first_.back(); }
  std::vector<std::size_t> const& coarse_first() const { return coarse_first_; }

  void restrict_values(ConstPoints fine, Points coarse) const;  // least squares; overwrites
  void prolong_values(ConstPoints coarse, Points fine) const;   // interpolation; overwrites
  void coarse_weights(ConstVector fine, Vector coarse) const;   // um; same total length per fiber

 private:
  struct Rule {
    Eigen::MatrixXd restriction, prolongation;
    Eigen::VectorXd weights;  // sum 1
  };
  static Rule make_rule(int n_fine, int n_coarse);

  std::vector<std::size_t> first_, coarse_first_;
  std::map<int, Rule> rules_;  // by the number of fine nodes
};

}  // namespace asterflow
