#include "linalg/recycling.hpp"

#include "linalg/gmres.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>

using namespace asterflow;

namespace {

constexpr int n = 5000;

// Nearly the identity, but for a few directions that are stretched or shrunk; `drift` changes it slowly.
struct Problem {
  Eigen::MatrixXd basis;
  Eigen::VectorXd stretch, b;
  explicit Problem(double drift) : basis(n, 12), stretch(12), b(n) {
    Eigen::MatrixXd columns(n, 12);
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < n; ++i) columns(i, j) = std::cos(0.37 * i * (j + 1) + drift * j * std::sin(0.1 * i));
    basis = columns.householderQr().householderQ() * Eigen::MatrixXd::Identity(n, 12);
    for (int j = 0; j < 12; ++j) stretch[j] = j % 2 == 0 ? 3.0 + j : 0.04 * (j + 1);
    for (int i = 0; i < n; ++i) b[i] = std::sin(1.0 + i * (1.0 + drift));
  }
  void apply(ConstVector x, Vector y) const {
    Eigen::Map<Eigen::VectorXd const> const input(x.data(), n);
    Eigen::Map<Eigen::VectorXd>(y.data(), n) =
        input + basis * ((stretch.array() - 1.0).matrix().asDiagonal() * (basis.transpose() * input));
  }
};

// Iterations to 1e-8 with what `memory` holds; it learns from them.
int iterations(Problem const& problem, Recycling& memory) {
  Eigen::MatrixXf inputs(n, 0), outputs(n, 0);
  auto const a = [&](ConstVector x, Vector y) {
    problem.apply(x, y);
    inputs.conservativeResize(n, inputs.cols() + 1);
    outputs.conservativeResize(n, outputs.cols() + 1);
    inputs.rightCols(1) = Eigen::Map<Eigen::VectorXd const>(x.data(), n).cast<float>();
    outputs.rightCols(1) = Eigen::Map<Eigen::VectorXd const>(y.data(), n).cast<float>();
  };
  auto const recall = [&](ConstVector r, Vector z) {
    std::copy(r.begin(), r.end(), z.begin());
    memory.precondition(z);
  };
  std::vector<double> x(n, 0.0);
  auto const result = solve_gmres(a, recall, {problem.b.data(), n}, x, {.tolerance = 1e-8});
  EXPECT_TRUE(result.converged);
  memory.learn(inputs, outputs, result.iterations / 8.0);
  return result.iterations;
}

}  // namespace

TEST(Recycling, makes_the_same_problem_easy) {
  Problem const problem(0.0);
  Recycling memory(12);
  EXPECT_GE(iterations(problem, memory), 10);
  EXPECT_EQ(memory.size(), 12);
  EXPECT_LE(iterations(problem, memory), 3);
}

TEST(Recycling, makes_a_problem_easier_that_has_changed_a_little) {
  Recycling memory(12);
  int const first = iterations(Problem(0.0), memory);
  EXPECT_LE(iterations(Problem(1e-4), memory), (2 * first) / 3);
}

TEST(Recycling, does_nothing_to_vectors_of_another_size) {
  Recycling memory(12);
  iterations(Problem(0.0), memory);
  std::vector<double> other(10, 1.0);
  memory.precondition(other);
  EXPECT_EQ(other, std::vector<double>(10, 1.0));
}

TEST(Recycling, forgets_what_no_longer_helps) {
  Recycling memory(12);
  int const without = iterations(Problem(0.0), memory);
  EXPECT_GT(iterations(Problem(0.5), memory), (9 * without) / 10);  // another problem
  EXPECT_EQ(memory.size(), 0);
  EXPECT_LE(iterations(Problem(0.5), memory), without + 2);
  EXPECT_EQ(memory.size(), 12);
}
