// Error of the flow that a surface gives to the boundary velocity of a point force near it, by the distance of the force: on
// the other side of the surface, at 1.33, 1.5 and 2 times it (or 1 / that, for the fluid outside). Largest over places and
// directions of the force and all depths of the target, relative to the largest velocity there. JSON, one line.
//   bench_nearby_force inside|outside ORDER a b c [RINGS]
// ORDER 0: that of `run.accuracy` = 1e-6. RINGS: other than those of a run.

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"
#include "surface/dirichlet_flow.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <random>
#include <string_view>

using namespace asterflow;

namespace {

Vec3d scaled(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

class Directions {
 public:
  Vec3d next() { return normalized(Vec3d{normal_(random_), normal_(random_), normal_(random_)}); }

 private:
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

// Sources at the ends of the axes, where errors are largest, and elsewhere.
double worst_error(DirichletFlow const& flow, Vec3d semi_axes, double source_scale) {
  bool const is_inside = flow.side() == Side::interior;
  Directions directions;
  double worst = 0.0;
  for (int place = 0; place < 9; ++place) {
    Vec3d at = directions.next(), axis;
    axis[place % 3] = 1.0;
    if (place < 3) at = axis;
    Vec3d const source = source_scale * scaled(semi_axes, at), force = directions.next();
    PointArray w, targets;
    for (Vec3d const x : flow.surface().nodes()) w.push_back(Stokeslet::velocity(x - source, force));
    for (double const depth : {0.0, 1e-6, 1e-3, 0.02, 0.1, 0.3, 0.6})
      for (int i = 0; i < 200; ++i) {
        Vec3d const d = i < 100 ? directions.next() : normalized(at + (0.01 * i - 1.0) * directions.next());
        targets.push_back((is_inside ? 1.0 - depth : 1.0 / (1.0 - depth)) * scaled(semi_axes, d));
      }
    PointArray u(targets.size());
    flow.add_velocity(w, flow.plan(targets), u);
    double error = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      Vec3d const exact = Stokeslet::velocity(targets[i] - source, force);
      error = std::max(error, norm(u[i] - exact));
      largest = std::max(largest, norm(exact));
    }
    worst = std::max(worst, error / largest);
  }
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    fmt::print(stderr, "usage: bench_nearby_force inside|outside ORDER a b c [RINGS]\n");
    return 1;
  }
  ParallelScope const threads;
  bool const is_inside = std::string_view(argv[1]) == "inside";
  ShapeSpec spec;
  spec.kind = ShapeSpec::Kind::ellipsoid;
  for (int i = 0; i < 3; ++i) spec.semi_axes[i] = std::atof(argv[3 + i]);
  auto const shape = make_shape(spec);
  int const order = std::atoi(argv[2]) > 0 ? std::atoi(argv[2]) : default_order(*shape, 1e-6);
  SphereGrid const grid = argc > 6 ? SphereGrid(order, std::atoi(argv[6])) : grid_of_order(*shape, order);
  DirichletFlow const flow(Surface(shape, grid), is_inside ? Side::interior : Side::exterior, 1e-9);
  fmt::print("{{\"side\": \"{}\", \"order\": {}, \"rings\": {}, \"nodes\": {}", argv[1], order, grid.n_ring(), grid.size());
  for (double const scale : {1.33, 1.5, 2.0})
    fmt::print(", \"{}\": {:.2g}", scale, worst_error(flow, spec.semi_axes, is_inside ? scale : 1.0 / scale));
  fmt::print("}}\n");
}
