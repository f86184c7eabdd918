#include "linalg/gmres.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

using namespace asterflow;

namespace {

// A well-conditioned, non-symmetric system with a known solution.
struct Problem {
  Eigen::MatrixXd a;
  Eigen::VectorXd solution, b;
  explicit Problem(int n) : a(n, n), solution(n) {
    for (int i = 0; i < n; ++i) {
      solution[i] = std::sin(1.0 + i);
      for (int j = 0; j < n; ++j) a(i, j) = (i == j ? 4.0 : 0.0) + std::cos(3.0 * i + 7.0 * j) / std::sqrt(n);
    }
    b = a * solution;
  }
  LinearOperator apply() const {
    return [this](ConstVector x, Vector y) {
      Eigen::Map<Eigen::VectorXd>(y.data(), y.size()) = a * Eigen::Map<Eigen::VectorXd const>(x.data(), x.size());
    };
  }
};

ConstVector view(Eigen::VectorXd const& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
Vector view(Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

}  // namespace

TEST(Gmres, reaches_the_tolerance_it_reports) {
  Problem const p(50);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(50);
  auto const result = solve_gmres(p.apply(), {}, view(p.b), view(x), {.tolerance = 1e-10});
  EXPECT_TRUE(result.converged);
  EXPECT_LT((p.b - p.a * x).norm() / p.b.norm(), 1.1e-10);
}

TEST(Gmres, exact_preconditioner_needs_one_iteration) {
  Problem const p(30);
  Eigen::PartialPivLU<Eigen::MatrixXd> const lu(p.a);
  auto const inverse = [&](ConstVector x, Vector y) {
    Eigen::Map<Eigen::VectorXd>(y.data(), y.size()) = lu.solve(Eigen::Map<Eigen::VectorXd const>(x.data(), x.size()));
  };
  Eigen::VectorXd x = Eigen::VectorXd::Zero(30);
  EXPECT_EQ(solve_gmres(p.apply(), inverse, view(p.b), view(x), {.tolerance = 1e-12}).iterations, 1);
}

TEST(Gmres, restart_still_converges) {
  Problem const p(60);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(60);
  auto const result = solve_gmres(p.apply(), {}, view(p.b), view(x), {.tolerance = 1e-10, .restart = 4});
  EXPECT_TRUE(result.converged);
  EXPECT_LT((x - p.solution).norm(), 1e-8);
}

TEST(Gmres, starts_from_the_guess_and_stops_at_once_when_it_is_exact) {
  Problem const p(20);
  Eigen::VectorXd x = p.solution;
  EXPECT_EQ(solve_gmres(p.apply(), {}, view(p.b), view(x), {.tolerance = 1e-8}).iterations, 0);
}

TEST(Gmres, says_so_when_it_does_not_converge) {
  Problem const p(50);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(50);
  EXPECT_FALSE(solve_gmres(p.apply(), {}, view(p.b), view(x), {.tolerance = 1e-12, .max_iterations = 2}).converged);
}

TEST(Gmres, zero_right_hand_side_gives_zero) {
  Problem const p(10);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(10);
  Eigen::VectorXd const zero = Eigen::VectorXd::Zero(10);
  EXPECT_TRUE(solve_gmres(p.apply(), {}, view(zero), view(x), {}).converged);
  EXPECT_EQ(x.norm(), 0.0);
}
