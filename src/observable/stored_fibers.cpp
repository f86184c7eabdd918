#include "observable/stored_fibers.hpp"

#include "base/error.hpp"
#include "io/frame.hpp"
#include "linalg/quadrature.hpp"

#include <map>

namespace asterflow {
namespace {

void add_scene_fibers(Scene const& scene, StoredFibers& fibers) {
  for (auto const& fiber : scene.fibers) {
    fibers.material.push_back(fiber.material);
    fibers.external_load.push_back(fiber.force_density);
  }
  for (auto const& aster : scene.asters) {
    fibers.material.insert(fibers.material.end(), aster.count, aster.material);
    fibers.external_load.insert(fibers.external_load.end(), aster.count, Vec3d{});
  }
}

// Gauss-Legendre points of [0, 1], with its ends when asked for.
Eigen::VectorXd points_of_fiber(int n_node, bool with_ends) {
  auto const& rule = gauss_legendre(n_node);
  Eigen::VectorXd points(n_node + (with_ends ? 2 : 0));
  for (int i = 0; i < n_node; ++i) points[i + (with_ends ? 1 : 0)] = 0.5 * (1.0 + rule.nodes[i]);
  if (with_ends) points[0] = 0.0, points[n_node + 1] = 1.0;
  return points;
}

// Of Lagrange interpolation: w_i = 1 / prod_j (x_i - x_j).
Eigen::VectorXd barycentric_weights(Eigen::VectorXd const& x) {
  Eigen::VectorXd w = Eigen::VectorXd::Ones(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    for (Eigen::Index j = 0; j < x.size(); ++j)
      if (j != i) w[i] /= 4.0 * (x[i] - x[j]);  // 4: so that many points neither overflow nor vanish
  return w;
}

// Values at the points -> derivatives at the points.
Eigen::MatrixXd const& differentiation(int n_node) {
  static thread_local std::map<int, Eigen::MatrixXd> known;
  Eigen::MatrixXd& matrix = known[n_node];
  if (matrix.size() > 0) return matrix;
  Eigen::VectorXd const x = points_of_fiber(n_node, true), w = barycentric_weights(x);
  matrix = Eigen::MatrixXd::Zero(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    for (Eigen::Index j = 0; j < x.size(); ++j)
      if (i != j) {
        matrix(i, j) = w[j] / w[i] / (x[i] - x[j]);
        matrix(i, i) -= matrix(i, j);
      }
  return matrix;
}

}  // namespace

StoredFibers stored_fibers(Scene const& scene, Frame const& frame) {
  StoredFibers fibers;
  fibers.first = integers_of(frame, "fiber/first");
  fibers.length = numbers_of(frame, "fiber/length");
  fibers.minus_end = points_of(frame, "fiber/minus_end");
  fibers.plus_end = points_of(frame, "fiber/plus_end");
  fibers.position = points_of(frame, "fiber/position");
  fibers.weight = numbers_of(frame, "fiber/weight");
  fibers.tension = numbers_of(frame, "fiber/tension");
  fibers.force_density = points_of(frame, "fiber/force_density");
  fibers.body = integers_of(frame, "fiber/body");
  fibers.tip_state = integers_of(frame, "fiber/tip_state");
  fibers.plus_end_force = points_of(frame, "fiber/plus_end_force");
  fibers.minus_end_force = points_of(frame, "fiber/minus_end_force");
  fibers.minus_end_torque = points_of(frame, "fiber/minus_end_torque");
  fibers.contact_force = points_of(frame, "fiber/contact_force");
  fibers.contact_torque = points_of(frame, "fiber/contact_torque");
  fibers.motor_load = numbers_of(frame, "fiber/motor_load");
  std::size_t const n = fibers.count();
  if (fibers.first.empty()) fibers.first.push_back(0);
  fibers.tip_state.resize(n);
  for (auto* forces : {&fibers.plus_end_force, &fibers.minus_end_force, &fibers.minus_end_torque, &fibers.contact_force,
                       &fibers.contact_torque})
    forces->resize(n);
  fibers.motor_load.resize(n);
  add_scene_fibers(scene, fibers);
  if (fibers.material.size() != n || fibers.first.size() != n + 1 || fibers.position.size() != fibers.weight.size())
    throw SceneError("the fibers of the stored state are not those of the scene");
  return fibers;
}

void differentiate(StoredFibers const& fibers, std::size_t fiber, Points tangents, Points curvatures) {
  int const n = fibers.node_count(fiber);
  Eigen::MatrixXd shape(n + 2, 3);
  for (int k = 0; k < 3; ++k) {
    shape(0, k) = fibers.minus_end[fiber][k];
    for (int i = 0; i < n; ++i) shape(i + 1, k) = fibers.position[fibers.first[fiber] + i][k];
    shape(n + 1, k) = fibers.plus_end[fiber][k];
  }
  Eigen::MatrixXd const& d = differentiation(n);
  Eigen::MatrixXd const slope = d * shape / fibers.length[fiber], bend = d * slope / fibers.length[fiber];
  for (int i = 0; i < n; ++i) {
    tangents[i] = normalized(Vec3d{slope(i + 1, 0), slope(i + 1, 1), slope(i + 1, 2)});
    curvatures[i] = {bend(i + 1, 0), bend(i + 1, 1), bend(i + 1, 2)};
  }
}

Vec3d value_at_end(ConstPoints field, double alpha) {
  Eigen::VectorXd const x = points_of_fiber(static_cast<int>(field.size()), false), w = barycentric_weights(x);
  Vec3d sum{};
  double total = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    double const share = w[i] / (alpha - x[i]);
    sum += share * field[i];
    total += share;
  }
  return sum / total;
}

}  // namespace asterflow
