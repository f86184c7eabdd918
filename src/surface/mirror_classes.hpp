#pragma once
// Vector fields on the nodes of a surface with three mirror planes, split by parity: class s = (s_1, s_2, s_3) holds the
// fields with u_c(M_d x) = +-s_d u_c(x), minus where c = d, for the mirrors M_d normal to the axes e_d. A linear operator
// that commutes with the mirrors has eight blocks, an eighth of the size each, and is known from its rows at one octant.
// Coefficients are orthonormal: of representative node r and component c, sum over r's images of sign u_c / |images|^(1/2).

#include "surface/surface.hpp"

#include <array>

namespace asterflow {

class MirrorClasses {
 public:
  static constexpr int count = 8;

  // Plain grids (uniform grading) of shapes whose centre is the origin of mirrors normal to all three axes.
  explicit MirrorClasses(Surface const& surface);

  std::vector<std::size_t> const& representatives() const { return representatives_; }  // nodes, one of each octant's
  Eigen::Index size(int mirror_class) const { return size_[mirror_class]; }
  // Index of the coefficient of a representative and a component, -1 where the class forbids it.
  Eigen::Index index(int mirror_class, std::size_t representative, int component) const {
    return index_[mirror_class][3 * representative + component];
  }

  // Components of the field are along (e_1, e_2, e_3).
  Eigen::VectorXd analyse(int mirror_class, ConstPoints field) const;
  void add_synthesis(int mirror_class, Eigen::Ref<Eigen::VectorXd const> coefficients, Points field) const;
  // Row of an operator at a representative node, per component of its input (3 x 3 n_node, components along the axes)
  // -> row of the class's block: [3, size(class)], scaled as coefficients of the output.
  Eigen::Matrix<double, 3, Eigen::Dynamic> fold(int mirror_class, std::size_t representative,
                                                Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic> const> rows) const;
  // The same for functionals of the field: [n, 3 n_node] -> [n, size(class)].
  Eigen::MatrixXd fold_functionals(int mirror_class, Eigen::Ref<Eigen::MatrixXd const> rows) const;

 private:
  struct Image {
    std::size_t node;
    int mirrors;  // bit d: reflected by M_d
  };
  static double sign(int mirror_class, int mirrors, int component);

  std::size_t n_node_;
  std::vector<std::size_t> representatives_;
  std::vector<std::vector<Image>> images_;                    // [representative] distinct nodes, itself first
  std::array<std::vector<Eigen::Index>, count> index_;        // [class][3 representative + component]
  std::array<Eigen::Index, count> size_{};
};

}  // namespace asterflow
