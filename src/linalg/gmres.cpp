#include "linalg/gmres.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Modified Gram-Schmidt loses no digit of a solution [Paige, Rozloznik & Strakos 2006], but a basis vector that is
// nearly all rounding would not be told from an exhausted space.
constexpr double reorthogonalise = 1e-3;  // what is left of a vector over what is taken out

Eigen::Map<VectorXd const> as_eigen(ConstVector v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

// Least-squares problem min |beta e1 - H y| kept triangular by Givens rotations, one column at a time.
class HessenbergSystem {
 public:
  HessenbergSystem(int n, double beta) : r_(MatrixXd::Zero(n + 1, n)), g_(VectorXd::Zero(n + 1)) { g_[0] = beta; }

  // Appends column j of H (j + 2 entries); returns the new residual norm.
  double append(int j, VectorXd column) {
    for (int i = 0; i < j; ++i) rotations_[i].apply(column[i], column[i + 1]);
    rotations_.push_back(Rotation::eliminating(column[j], column[j + 1]));
    rotations_[j].apply(column[j], column[j + 1]);
    rotations_[j].apply(g_[j], g_[j + 1]);
    r_.col(j).head(j + 1) = column.head(j + 1);
    return std::abs(g_[j + 1]);
  }

  VectorXd solve(int n) const {
    return r_.topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(g_.head(n));
  }

 private:
  struct Rotation {
    double c, s;
    static Rotation eliminating(double a, double b) {
      double const h = std::hypot(a, b);
      return h > 0 ? Rotation{a / h, b / h} : Rotation{1.0, 0.0};
    }
    void apply(double& a, double& b) const {
      double const t = c * a + s * b;
      b = c * b - s * a;
      a = t;
    }
  };
  MatrixXd r_;
  VectorXd g_;
  std::vector<Rotation> rotations_;
};

}  // namespace

GmresResult solve_gmres(LinearOperator const& a, LinearOperator const& preconditioner, ConstVector b, Vector x,
                        GmresOptions const& options) {
  ASTERFLOW_REQUIRE(b.size() == x.size());
  auto const n = static_cast<Eigen::Index>(b.size());
  Eigen::Map<VectorXd> solution(x.data(), n);
  double const reference = options.reference > 0 ? options.reference : as_eigen(b).norm();
  GmresResult result;
  if (reference == 0.0) {
    solution.setZero();
    result.converged = true;
    return result;
  }
  int const m = std::min<int>(options.restart, options.max_iterations);
  std::vector<VectorXd> v, z;
  VectorXd w(n);
  while (true) {
    VectorXd r = as_eigen(b);
    if (!solution.isZero(0.0)) {
      a(x, {w.data(), b.size()});
      r -= w;
    }
    double const beta = r.norm();
    result.residual = beta / reference;
    result.converged = result.residual <= options.tolerance;
    if (options.monitor) options.monitor(result.residual);
    if (result.converged || result.iterations >= options.max_iterations || !std::isfinite(beta)) return result;

    HessenbergSystem hessenberg(m, beta);
    v.assign(1, r / beta);
    z.clear();
    int j = 0;
    for (bool done = false; !done && j < m && result.iterations < options.max_iterations; ++j) {
      z.emplace_back(v[j]);
      if (preconditioner) preconditioner({v[j].data(), b.size()}, {z[j].data(), b.size()});
      a({z[j].data(), b.size()}, {w.data(), b.size()});
      ++result.iterations;
      VectorXd column(j + 2);
      column.setZero();
      for (int pass = 0; pass < 2; ++pass) {  // modified Gram-Schmidt, again where cancellation would show
        for (int i = 0; i <= j; ++i) {
          double const h = v[i].dot(w);
          column[i] += h;
          w -= h * v[i];
        }
        column[j + 1] = w.norm();
        if (column[j + 1] > reorthogonalise * column.head(j + 1).norm()) break;
      }
      bool const exhausted = column[j + 1] <= 1e-15 * column.head(j + 1).norm();
      if (!exhausted) v.emplace_back(w / column[j + 1]);
      result.residual = hessenberg.append(j, column) / reference;
      result.converged = result.residual <= options.tolerance;
      if (options.monitor) options.monitor(result.residual);
      done = result.converged || exhausted;
    }
    VectorXd const y = hessenberg.solve(j);
    for (int i = 0; i < j; ++i) solution += y[i] * z[i];
    if (result.converged) return result;
  }
}

}  // namespace asterflow
