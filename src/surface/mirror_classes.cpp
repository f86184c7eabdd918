#include "surface/mirror_classes.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace asterflow {

// Bit d of the class: s_d = -1.
double MirrorClasses::sign(int mirror_class, int mirrors, int component) {
  int const flips = std::popcount(static_cast<unsigned>(mirror_class & mirrors)) + ((mirrors >> component) & 1);
  return flips % 2 ? -1.0 : 1.0;
}

MirrorClasses::MirrorClasses(Surface const& surface) : n_node_(surface.size()) {
  ASTERFLOW_REQUIRE(surface.grading().uniform());
  int const n_ring = surface.grid().n_ring(), n = surface.grid().n_azimuth();
  auto const mirrored = [&](int j, int k, int mirrors) {
    if (mirrors & 1) j = n_ring - 1 - j;
    if (mirrors & 2) k = (n / 2 - k + n) % n;
    if (mirrors & 4) k = (n - k) % n;
    return static_cast<std::size_t>(j) * n + k;
  };
  for (auto& index : index_) index.clear();
  for (int j = 0; j < n_ring; ++j)
    for (int k = 0; k < n; ++k) {
      std::size_t const node = mirrored(j, k, 0);
      std::vector<Image> images;
      std::vector<int> stabiliser;
      bool is_first = true;
      for (int mirrors = 0; mirrors < count; ++mirrors) {
        std::size_t const image = mirrored(j, k, mirrors);
        is_first = is_first && image >= node;
        if (image == node) stabiliser.push_back(mirrors);
        if (std::ranges::find(images, image, &Image::node) == images.end()) images.push_back({image, mirrors});
      }
      if (!is_first) continue;
      representatives_.push_back(node);
      images_.push_back(images);
      for (int s = 0; s < count; ++s)
        for (int c = 0; c < 3; ++c) {
          bool const is_allowed = std::ranges::all_of(stabiliser, [&](int mirrors) { return sign(s, mirrors, c) > 0; });
          index_[s].push_back(is_allowed ? size_[s]++ : -1);
        }
    }
}

Eigen::VectorXd MirrorClasses::analyse(int s, ConstPoints field) const {
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(size_[s]);
  for (std::size_t r = 0; r < images_.size(); ++r) {
    double const scale = 1.0 / std::sqrt(static_cast<double>(images_[r].size()));
    for (int c = 0; c < 3; ++c)
      if (Eigen::Index const i = index(s, r, c); i >= 0)
        for (Image const& image : images_[r]) coefficients[i] += scale * sign(s, image.mirrors, c) * field[image.node][c];
  }
  return coefficients;
}

void MirrorClasses::add_synthesis(int s, Eigen::Ref<Eigen::VectorXd const> coefficients, Points field) const {
  for (std::size_t r = 0; r < images_.size(); ++r) {
    double const scale = 1.0 / std::sqrt(static_cast<double>(images_[r].size()));
    for (int c = 0; c < 3; ++c)
      if (Eigen::Index const i = index(s, r, c); i >= 0)
        for (Image const& image : images_[r]) field[image.node][c] += scale * sign(s, image.mirrors, c) * coefficients[i];
  }
}

Eigen::MatrixXd MirrorClasses::fold_functionals(int s, Eigen::Ref<Eigen::MatrixXd const> rows) const {
  Eigen::MatrixXd folded = Eigen::MatrixXd::Zero(rows.rows(), size_[s]);
  for (std::size_t r = 0; r < images_.size(); ++r) {
    double const scale = 1.0 / std::sqrt(static_cast<double>(images_[r].size()));
    for (int c = 0; c < 3; ++c)
      if (Eigen::Index const i = index(s, r, c); i >= 0)
        for (Image const& image : images_[r])
          folded.col(i) += scale * sign(s, image.mirrors, c) * rows.col(static_cast<Eigen::Index>(3 * image.node) + c);
  }
  return folded;
}

Eigen::Matrix<double, 3, Eigen::Dynamic> MirrorClasses::fold(
    int s, std::size_t representative, Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic> const> rows) const {
  return std::sqrt(static_cast<double>(images_[representative].size())) * fold_functionals(s, rows);
}

}  // namespace asterflow
