#include "system/fiber_coarsening.hpp"

#include "base/parallel.hpp"
#include "fiber/legendre.hpp"

#include <algorithm>
#include <numeric>

namespace asterflow {
namespace {

using RowMajor3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

Eigen::Map<RowMajor3 const> rows(ConstPoints p, std::size_t first, std::size_t n) {
  return {&p[first].x, static_cast<Eigen::Index>(n), 3};
}
Eigen::Map<RowMajor3> rows(Points p, std::size_t first, std::size_t n) {
  return {&p[first].x, static_cast<Eigen::Index>(n), 3};
}

}  // namespace

FiberCoarsening::FiberCoarsening(std::vector<std::size_t> first, int divisor)
    : first_(std::move(first)), coarse_first_{0} {
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
    int const n = static_cast<int>(first_[i + 1] - first_[i]);
    int const n_coarse = std::min(n, std::max(4, n / divisor));
    if (!rules_.contains(n)) rules_[n] = make_rule(n, n_coarse);
    coarse_first_.push_back(coarse_first_.back() + n_coarse);
  }
}

FiberCoarsening::Rule FiberCoarsening::make_rule(int n_fine, int n_coarse) {
  UnitRule const fine = gauss_rule(n_fine), coarse = gauss_rule(n_coarse);
  Eigen::VectorXd norms(n_coarse);  // 1 / integral of P_k^2 over [0, 1]
  for (int k = 0; k < n_coarse; ++k) norms[k] = 2 * k + 1;
  auto const transfer = [&](UnitRule const& from, UnitRule const& to) -> Eigen::MatrixXd {
    return legendre_values(to.nodes, n_coarse) * norms.asDiagonal() *
           legendre_values(from.nodes, n_coarse).transpose() * from.weights.asDiagonal();
  };
  return {transfer(fine, coarse), transfer(coarse, fine), coarse.weights};
}

void FiberCoarsening::restrict_values(ConstPoints fine, Points coarse) const {
  parallel_for("FiberCoarsening::restrict_values", static_cast<long>(first_.size()) - 1, [&](long i) {
    std::size_t const n = first_[i + 1] - first_[i];
    rows(coarse, coarse_first_[i], coarse_first_[i + 1] - coarse_first_[i]).noalias() =
        rules_.at(static_cast<int>(n)).restriction * rows(fine, first_[i], n);
  });
}

void FiberCoarsening::prolong_values(ConstPoints coarse, Points fine) const {
  parallel_for("FiberCoarsening::prolong_values", static_cast<long>(first_.size()) - 1, [&](long i) {
    std::size_t const n = first_[i + 1] - first_[i];
    rows(fine, first_[i], n).noalias() = rules_.at(static_cast<int>(n)).prolongation *
                                         rows(coarse, coarse_first_[i], coarse_first_[i + 1] - coarse_first_[i]);
  });
}

void FiberCoarsening::coarse_weights(ConstVector fine, Vector coarse) const {
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
    auto const own = fine.subspan(first_[i], first_[i + 1] - first_[i]);
    double const length = std::accumulate(own.begin(), own.end(), 0.0);
    auto const& weights = rules_.at(static_cast<int>(own.size())).weights;
    for (std::size_t k = coarse_first_[i]; k < coarse_first_[i + 1]; ++k)
      coarse[k] = length * weights[k - coarse_first_[i]];
  }
}

}  // namespace asterflow
