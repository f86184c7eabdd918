// Error of the flow of a point force close to the cortex (25 x 15 x 15 um, or other semi-axes), relative to the flow of the same
// force without a cell: largest over normal and tangential forces, by the depth of the target. JSON, one line a case.
//   bench_screening ORDER [ACCURACY] [a b c]
// The reference has order 56 and images that follow the curvature. samples: nodes take samples of forces; projected: surface/screened_forces.hpp.

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"
#include "system/flows.hpp"
#include "system/wall_images.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <random>

using namespace asterflow;

namespace {

constexpr std::array depths{1.0, 3.0, 6.0, 100.0};  // um, upper ends of the classes of targets

struct Cell {
  std::unique_ptr<DirichletFlow> flow;
  ImageWall wall;
  std::shared_ptr<ScreenedForces const> screened;
};

Cell make_cell(Vec3d axes, int order, double accuracy, bool is_curved) {
  ShapeSpec const spec{.kind = ShapeSpec::Kind::ellipsoid, .semi_axes = axes};
  auto flow = std::make_unique<DirichletFlow>(plain_surface(spec, order), Side::interior, accuracy);
  ImageWall const wall(flow->surface(), Side::interior, is_curved);
  return {std::move(flow), wall, make_screened_forces(wall, accuracy)};
}

PointArray velocities(Cell const& cell, bool is_projected, ConstPoints targets, Vec3d position, Vec3d force) {
  Surface const& wall = cell.flow->surface();
  WallImages images(cell.wall, is_projected ? cell.screened : nullptr);
  PointArray const forces{force}, positions{position};
  images.place({}, positions, std::vector{1e-3}, {0, 1});
  PointArray at_wall(wall.size()), u(targets.size());
  for (std::size_t i = 0; i < at_wall.size(); ++i) at_wall[i] = Stokeslet::velocity(wall.nodes()[i] - position, force);
  images.add_velocity_at_wall(forces, wall.nodes(), at_wall);
  for (Vec3d& w : at_wall) w = -w;
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = Stokeslet::velocity(targets[i] - position, force);
  images.add_velocity<double>(forces, targets, u);
  cell.flow->add_velocity(at_wall, cell.flow->plan(targets), u);
  return u;
}

// All over the cell, and around the force.
PointArray make_targets(Shape const& shape, Vec3d axes, Vec3d force) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  auto const direction = [&] { return normalized(Vec3d{normal(random), normal(random), normal(random)}); };
  PointArray targets;
  for (int i = 0; i < 600; ++i) {
    Vec3d const d = 0.98 * std::cbrt(uniform(random)) * direction();
    targets.push_back({axes.x * d.x, axes.y * d.y, axes.z * d.z});
  }
  for (double const r : {0.3, 1.0, 3.0})
    for (int i = 0; i < 16; ++i) {
      Vec3d const x = force + r * direction();
      if (shape.signed_distance(x) < -0.01) targets.push_back(x);
    }
  return targets;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_screening ORDER [ACCURACY] [a b c]\n");
    return 1;
  }
  ParallelScope const threads;
  int const order = std::atoi(argv[1]);
  double const accuracy = argc > 2 ? std::atof(argv[2]) : 1e-6;
  Vec3d const axes = argc > 5 ? Vec3d{std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])} : Vec3d{25, 15, 15};
  Cell const plane = make_cell(axes, order, accuracy, false), curved = make_cell(axes, order, accuracy, true),
             reference = make_cell(axes, 56, 1e-8, true);
  Shape const& shape = reference.flow->surface().shape();
  Vec3d const d = normalized(Vec3d{0.4, 0.7, 0.35}), wall{axes.x * d.x, axes.y * d.y, axes.z * d.z};
  Vec3d const n = shape.closest_point(wall).normal, t = normalized(cross(n, Vec3d{0.3, 1, 0.2}));
  for (double const distance : {0.02, 0.1, 0.5, 1.5, 3.0, 5.0}) {
    Vec3d const position = wall - distance * n;
    PointArray const targets = make_targets(shape, axes, position);
    PointArray const exact[2] = {velocities(reference, true, targets, position, n), velocities(reference, true, targets, position, t)};
    for (auto const& [is_curved, is_projected] : {std::pair{false, false}, {false, true}, {true, false}, {true, true}}) {
      std::array<double, depths.size()> worst{};
      for (int c = 0; c < 2; ++c) {
        PointArray const u = velocities(is_curved ? curved : plane, is_projected, targets, position, c == 0 ? n : t);
        for (std::size_t i = 0; i < targets.size(); ++i) {
          std::size_t depth = 0;
          while (-shape.signed_distance(targets[i]) > depths[depth]) ++depth;
          worst[depth] = std::max(worst[depth], norm(u[i] - exact[c][i]) * 8 * M_PI * norm(targets[i] - position));
        }
      }
      fmt::print("{{\"order\": {}, \"distance\": {}, \"images\": \"{}\", \"nodes\": \"{}\", \"error_at_depth\": {{\"<1\": {:.1e}, "
                 "\"1-3\": {:.1e}, \"3-6\": {:.1e}, \">6\": {:.1e}}}}}\n", order, distance, is_curved ? "curved" : "plane",
                 is_projected ? "projected" : "samples", worst[0], worst[1], worst[2], worst[3]);
    }
  }
}
