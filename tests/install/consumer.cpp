// One unit force seen at distance 1 um on its axis, u = 2 F / (8 pi mu r), through the installed headers alone.

#include "backends/evaluator.hpp"
#include "kernels/stokeslet.hpp"

#include <Kokkos_Core.hpp>
#include <cmath>
#include <iostream>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  asterflow::PointArray const source{{0, 0, 0}}, target{{1, 0, 0}}, force{{1, 0, 0}};
  asterflow::PointArray velocity(1);

  auto const evaluator = asterflow::make_evaluator(asterflow::Stokeslet::name, {.backend = "reference"});
  evaluator->set_points(source, target);
  evaluator->add_velocity(force, velocity);

  double const expected = 1 / (4 * std::acos(-1.0));
  bool const agrees = std::abs(velocity[0].x - expected) < 1e-14;  // a few roundings of double
  if (!agrees) std::cerr << "velocity " << velocity[0].x << ", expected " << expected << '\n';
  return agrees ? 0 : 1;
}
