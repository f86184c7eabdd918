#pragma once
// A closed surface as quadrature nodes: a shape sampled on the Gauss-Legendre x trapezoid grid of order p.
// Spectrally accurate for smooth integrands: int f dS = sum_i weights[i] f(nodes[i]). Shape's own frame.

#include "base/arrays.hpp"
#include "surface/shapes.hpp"
#include "surface/sphere_grid.hpp"

namespace asterflow {

class Surface {
 public:
  Surface(std::shared_ptr<Shape const> shape, int order);

  Shape const& shape() const { return *shape_; }
  std::shared_ptr<Shape const> const& shared_shape() const { return shape_; }
  SphereGrid const& grid() const { return grid_; }
  int order() const { return grid_.order(); }
  std::size_t size() const { return grid_.size(); }

  ConstPoints nodes() const { return nodes_; }      // [size] um
  ConstPoints normals() const { return normals_; }  // [size] outward unit normals
  ConstVector weights() const { return weights_; }  // [size] um^2
  double area() const { return area_; }             // um^2
  double volume() const { return volume_; }         // um^3

 private:
  std::shared_ptr<Shape const> shape_;
  SphereGrid grid_;
  PointArray nodes_, normals_;
  std::vector<double> weights_;
  double area_ = 0.0, volume_ = 0.0;
};

}  // namespace asterflow
