#include "background/background_spec.hpp"

#include <cmath>

namespace asterflow {

BackgroundSpec read_background(Table table) {
  BackgroundSpec background;
  auto& g = background.gradient;
  table.read("velocity", background.velocity, any_number, "um/s");
  table.read("gradient", g, any_number, "1/s");
  double const trace = g[0].x + g[1].y + g[2].z;
  double const size = std::abs(g[0].x) + std::abs(g[1].y) + std::abs(g[2].z);
  if (std::abs(trace) > 1e-12 * size) table.fail("gradient", "must have trace 0: the fluid is incompressible");
  if (table.has("shear_rate") && table.has("gradient")) table.fail("give gradient or shear_rate, not both");
  table.read("shear_rate", g[0].y, any_number, "1/s");
  table.finish();
  return background;
}

}  // namespace asterflow
