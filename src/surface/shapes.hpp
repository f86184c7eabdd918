#pragma once
// Smooth closed shapes, star-shaped about their centre, as maps of the unit sphere: direction d -> point X(d).
// Lengths in um. Coordinates are the shape's own frame.

#include "base/arrays.hpp"
#include "surface/shape_spec.hpp"

#include <Eigen/Core>
#include <memory>
#include <string>

namespace asterflow {

// X(d) and its derivative: a tangent v of the unit sphere at d becomes jacobian * v.
struct SphereImage {
  Vec3d position;            // um
  Eigen::Matrix3d jacobian;  // um
};

struct ClosestPoint {
  Vec3d position;       // um, on the surface
  Vec3d normal;         // outward unit normal there
  double distance = 0;  // um, signed: negative inside
  Vec3d direction;      // d of the closest point
};

// x = centre + rho (X(d) - centre): rho < 1 inside, 1 on the surface, > 1 outside.
struct ShellPoint {
  double rho;
  Vec3d direction;  // any length
};

class Shape {
 public:
  virtual ~Shape() = default;

  virtual bool axisymmetric() const = 0;  // about the polar axis through the origin
  virtual Vec3d centre() const { return {}; }
  virtual SphereImage image(Vec3d direction) const = 0;
  // Images of many unit directions and their area vectors, outward, um^2 per unit solid angle; overwritten.
  using Columns = Eigen::Array<double, Eigen::Dynamic, 3>;  // x, y, z
  virtual void sample(Columns const& directions, Columns& positions, Columns& areas) const = 0;
  virtual ClosestPoint closest_point(Vec3d x) const = 0;
  virtual ShellPoint shell_point(Vec3d x) const = 0;
  virtual double size() const = 0;          // um, largest distance of the surface from the centre
  virtual double aspect_ratio() const = 0;  // largest over smallest distance of the surface from the centre, >= 1

  double signed_distance(Vec3d x) const { return closest_point(x).distance; }  // um, negative inside
  Vec3d point(double theta, double phi) const;  // um, image of the direction at polar angle theta from the polar axis
  // Axis of symmetry where there is one, else the longest axis; 0, 1, 2: x, y, z.
  int polar_axis() const { return polar_axis_; }

 protected:
  explicit Shape(int polar_axis) : polar_axis_(polar_axis) {}

 private:
  int polar_axis_;
};

// Throws SceneError where the description is not a shape (negative length, profile that is not star-shaped, ...).
std::shared_ptr<Shape const> make_shape(ShapeSpec const& spec);

}  // namespace asterflow
