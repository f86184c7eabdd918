#include "fiber/fitted_centreline.hpp"

#include "base/error.hpp"
#include "fiber/fiber_basis.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <vector>

namespace asterflow {

namespace {

// Natural cubic spline x(c) through points at chord lengths c.
struct Spline {
  ConstPoints points;
  std::vector<double> chord{0.0};  // [n_point] um
  PointArray bend;                 // [n_point] x''

  explicit Spline(ConstPoints p) : points(p), bend(p.size()) {
    for (std::size_t i = 1; i < p.size(); ++i) chord.push_back(chord.back() + norm(p[i] - p[i - 1]));
    Eigen::Index const n = p.size();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n), rhs = Eigen::MatrixXd::Zero(n, 3);
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      double const h = chord[i] - chord[i - 1], k = chord[i + 1] - chord[i];
      matrix.row(i).segment<3>(i - 1) << h / 6, (h + k) / 3, k / 6;
      rhs.row(i) = to_row((p[i + 1] - p[i]) / k - (p[i] - p[i - 1]) / h);
    }
    Eigen::MatrixXd const solution = matrix.partialPivLu().solve(rhs);
    for (Eigen::Index i = 0; i < n; ++i) bend[i] = {solution(i, 0), solution(i, 1), solution(i, 2)};
  }

  static Eigen::RowVector3d to_row(Vec3d a) { return {a.x, a.y, a.z}; }

  // Between points `next - 1` and `next`, `b` of the way from the one to the other.
  Vec3d position(std::size_t next, double b) const {
    std::size_t const i = next - 1;
    double const h = chord[next] - chord[i], a = 1.0 - b;
    return a * points[i] + b * points[next] + (h * h / 6) * ((a * a * a - a) * bend[i] + (b * b * b - b) * bend[next]);
  }

  Vec3d slope(double c) const {
    std::size_t const next = std::clamp<std::size_t>(std::upper_bound(chord.begin(), chord.end(), c) - chord.begin(), 1,
                                                     chord.size() - 1),
                      i = next - 1;
    double const h = chord[next] - chord[i], b = (c - chord[i]) / h, a = 1.0 - b;
    return (points[next] - points[i]) / h + (h / 6) * ((3 * b * b - 1) * bend[next] - (3 * a * a - 1) * bend[i]);
  }
};

}  // namespace

Centreline centreline_through(ConstPoints points, int n_node) {
  ASTERFLOW_REQUIRE(points.size() >= 2);
  FiberBasis const& basis = fiber_basis(n_node);
  Spline const spline(points);
  // Arc length at the ends of many small pieces of chord, by Simpson's rule.
  std::size_t const n_piece = 64 * (points.size() - 1);
  double const piece = spline.chord.back() / n_piece;
  std::vector<double> arc(n_piece + 1, 0.0);
  for (std::size_t i = 0; i < n_piece; ++i)
    arc[i + 1] = arc[i] + piece / 6 *
                              (norm(spline.slope(i * piece)) + 4 * norm(spline.slope((i + 0.5) * piece)) +
                               norm(spline.slope((i + 1) * piece)));
  Centreline shape{points.front(), arc.back(), PointArray(basis.n_tangent)};
  for (int j = 0; j < basis.n_tangent; ++j) {
    double const s = basis.lobatto.nodes[j] * shape.length;
    std::size_t const i =
        std::clamp<std::ptrdiff_t>(std::upper_bound(arc.begin(), arc.end(), s) - arc.begin() - 1, 0, n_piece - 1);
    shape.tangents[j] = normalized(spline.slope((i + (s - arc[i]) / (arc[i + 1] - arc[i])) * piece));
  }
  return shape;
}

PointArray points_between(ConstPoints points, int n_between) {
  ASTERFLOW_REQUIRE(points.size() >= 2);
  Spline const spline(points);
  PointArray all{points.front()};
  for (std::size_t next = 1; next < points.size(); ++next) {
    for (int j = 1; j <= n_between; ++j) all.push_back(spline.position(next, double(j) / (n_between + 1)));
    all.push_back(points[next]);
  }
  return all;
}

}  // namespace asterflow
