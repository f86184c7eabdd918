#pragma once
// A closed surface as quadrature nodes: a shape sampled on a Gauss-Legendre x trapezoid grid (sphere_grid.hpp), whose angles
// (t, phi) parametrise the shape through a grading of the sphere. Spectrally accurate for smooth integrands:
// int f dS = sum_i weights[i] f(nodes[i]). Coordinates are the shape's own frame.

#include "base/arrays.hpp"
#include "surface/grading.hpp"
#include "surface/shapes.hpp"
#include "surface/sphere_grid.hpp"

namespace asterflow {

// One point of the surface and its derivatives with respect to the grid angles.
struct SurfacePatch {
  Vec3d position;       // um
  Vec3d tangent_t;      // um
  Vec3d tangent_phi;    // um
  Vec3d area_vector() const { return cross(tangent_t, tangent_phi); }  // um^2, outward
};

// Grid angles of the closest point.
struct ClosestAngles {
  double t, phi;
  double distance;  // um, signed: negative inside
};

class Surface {
 public:
  // Without a grading: plain, about the shape's polar axis.
  Surface(std::shared_ptr<Shape const> shape, SphereGrid const& grid);
  Surface(std::shared_ptr<Shape const> shape, SphereGrid const& grid, Grading const& grading);

  Shape const& shape() const { return *shape_; }
  SphereGrid const& grid() const { return grid_; }
  Grading const& grading() const { return grading_; }
  int order() const { return grid_.order(); }
  std::size_t size() const { return grid_.size(); }
  double spacing() const;  // um, of the nodes of a plain grid, where they are farthest apart

  ConstPoints nodes() const { return nodes_; }      // [size] um
  ConstPoints normals() const { return normals_; }  // [size] outward unit normals
  ConstVector weights() const { return weights_; }  // [size] um^2
  double area() const { return area_; }             // um^2
  double volume() const { return volume_; }         // um^3

  bool axisymmetric() const { return axisymmetric_; }  // in phi, with its grid
  SurfacePatch patch(double t, double phi) const { return patch(grading_.polar_angle(t), phi); }
  SurfacePatch patch(Grading::PolarAngle ring, double phi) const;
  // Positions (um) and area vectors (um^2 per unit of t and phi) of one ring at many azimuths; overwritten.
  struct RingSample {
    Shape::Columns directions, positions, areas;
  };
  void sample_ring(Grading::PolarAngle ring, Eigen::ArrayXd const& cosines, Eigen::ArrayXd const& sines,
                   RingSample& sample) const;
  ClosestAngles closest_angles(Vec3d x) const;

  // Components along (e_1, e_2, e_3) of the grading, and back.
  Vec3d to_polar(Vec3d v) const;
  Vec3d from_polar(Vec3d v) const;

 private:
  std::shared_ptr<Shape const> shape_;
  SphereGrid grid_;
  Grading grading_;
  bool axisymmetric_;
  PointArray nodes_, normals_;
  std::vector<double> weights_;
  double area_ = 0.0, volume_ = 0.0;
};

}  // namespace asterflow
