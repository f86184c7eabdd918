#pragma once
// Smooth closed shapes, star-shaped about their centre and parametrised by the unit sphere:
//   direction d(theta, phi) = cos theta e_1 + sin theta (cos phi e_2 + sin phi e_3),  (e_1, e_2, e_3) right-handed,
// where e_1 is the shape's polar axis: the axis of symmetry where there is one, else the longest axis.
// Lengths in um. Coordinates are the shape's own frame.

#include "base/arrays.hpp"
#include "surface/shape_spec.hpp"

#include <memory>
#include <string>

namespace asterflow {

// One point of a parametrised surface and its derivatives.
struct SurfacePatch {
  Vec3d position;      // um
  Vec3d area_vector;   // um^2, d position / d theta x d position / d phi, outward
};

struct ClosestPoint {
  Vec3d position;       // um, on the surface
  Vec3d normal;         // outward unit normal there
  double distance = 0;  // um, signed: negative inside
  double theta = 0, phi = 0;
};

// x = centre + rho (X(theta, phi) - centre): rho < 1 inside, 1 on the surface, > 1 outside.
struct ShellPoint {
  double rho, theta, phi;
  double depth;  // 1 - rho without cancellation near the surface where the shape allows it
};

class Shape {
 public:
  virtual ~Shape() = default;

  virtual bool axisymmetric() const = 0;  // about the polar axis
  virtual Vec3d centre() const { return {}; }
  virtual SurfacePatch patch(double theta, double phi) const = 0;
  virtual ClosestPoint closest_point(Vec3d x) const = 0;
  virtual ShellPoint shell_point(Vec3d x) const = 0;
  virtual double size() const = 0;           // largest distance of the surface from the centre
  virtual double aspect_ratio() const = 0;   // largest over smallest distance of the surface from the centre, >= 1
  virtual std::string key() const = 0;       // identifies the shape to the last bit

  double signed_distance(Vec3d x) const { return closest_point(x).distance; }  // negative inside
  int polar_axis() const { return polar_axis_; }                               // 0, 1, 2: e_1 = x, y, z

  // Components along (e_1, e_2, e_3), a cyclic permutation of (x, y, z), and back.
  Vec3d to_polar(Vec3d v) const { return {v[polar_axis_], v[(polar_axis_ + 1) % 3], v[(polar_axis_ + 2) % 3]}; }
  Vec3d from_polar(Vec3d v) const { return {v[(3 - polar_axis_) % 3], v[(4 - polar_axis_) % 3], v[(5 - polar_axis_) % 3]}; }

 protected:
  explicit Shape(int polar_axis) : polar_axis_(polar_axis) {}

 private:
  int polar_axis_;
};

// Throws SceneError where the description is not a shape (negative length, profile that is not star-shaped, ...).
std::shared_ptr<Shape const> make_shape(ShapeSpec const& spec);

}  // namespace asterflow
