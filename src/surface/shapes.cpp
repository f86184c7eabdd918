#include "surface/shapes.hpp"

#include "base/error.hpp"
#include "surface/ellipsoid.hpp"
#include "surface/revolution.hpp"

#include <cmath>
#include <fmt/format.h>

namespace asterflow {
namespace {

void require_positive(char const* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw SceneError(fmt::format("shape: {} = {} um (must be positive)", name, value));
}

}  // namespace

Vec3d Shape::point(double theta, double phi) const {
  double const along = std::cos(theta), across[2] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi)};
  Vec3d direction;
  direction[polar_axis_] = along;
  for (int i : {0, 1}) direction[(polar_axis_ + 1 + i) % 3] = across[i];
  return image(direction).position;
}

std::shared_ptr<Shape const> make_shape(ShapeSpec const& spec) {
  switch (spec.kind) {
    case ShapeSpec::Kind::sphere:
      require_positive("radius", spec.radius);
      return std::make_shared<Ellipsoid>(Vec3d{spec.radius, spec.radius, spec.radius});
    case ShapeSpec::Kind::ellipsoid:
      for (int i = 0; i < 3; ++i) require_positive("semi_axes", spec.semi_axes[i]);
      return std::make_shared<Ellipsoid>(spec.semi_axes);
    case ShapeSpec::Kind::revolution: return std::make_shared<Revolution>(spec.profile);
  }
  throw InternalError("shape of unknown kind");
}

}  // namespace asterflow
