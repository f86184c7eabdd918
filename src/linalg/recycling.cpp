#include "linalg/recycling.hpp"

#include "base/parallel.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <vector>

namespace asterflow {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;

constexpr Index block_rows = 2048;
constexpr int solves_per_lesson = 3;

// body(block, first row, rows) over blocks of rows: the same blocks for any number of threads.
template <class Body>
Index for_row_blocks(Index rows, Body const& body) {
  Index const n_block = (rows + block_rows - 1) / block_rows;
  parallel_for("Recycling", n_block, [&](long i) {
    Index const first = i * block_rows;
    body(i, first, std::min(block_rows, rows - first));
  });
  return n_block;
}

// a^T b
MatrixXd gram(MatrixXf const& a, MatrixXf const& b) {
  std::vector<MatrixXf> parts((a.rows() + block_rows - 1) / block_rows);
  for_row_blocks(a.rows(), [&](Index i, Index first, Index n) {
    parts[i].noalias() = a.middleRows(first, n).transpose() * b.middleRows(first, n);
  });
  MatrixXd sum = MatrixXd::Zero(a.cols(), b.cols());
  for (auto const& part : parts) sum += part.cast<double>();
  return sum;
}

// Columns scaled to length one, their images with them.
void normalise(MatrixXf& w, MatrixXf& image) {
  for (Index j = 0; j < w.cols(); ++j) {
    float const scale = 1.0f / std::max(w.col(j).norm(), 1e-30f);
    w.col(j) *= scale;
    image.col(j) *= scale;
  }
}

// Coefficients y of the directions d y, d^T d = directions, to keep, of images a d with Gram matrix `images`: those that are
// stretched or shrunk most, scaled so that their images have length one.
MatrixXd most_changed(MatrixXd const& directions, MatrixXd const& images, Index capacity) {
  Eigen::SelfAdjointEigenSolver<MatrixXd> const basis(directions);
  VectorXd const& values = basis.eigenvalues();
  Index const all = values.size();
  Index kept = 0;  // the others are there twice
  while (kept < all && values[all - 1 - kept] > 1e-5 * values[all - 1]) ++kept;
  MatrixXd const s = basis.eigenvectors().rightCols(kept) * values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
  Eigen::SelfAdjointEigenSolver<MatrixXd> const stretch(s.transpose() * images * s);
  VectorXd const squares = stretch.eigenvalues().cwiseMax(1e-12);
  std::vector<Index> order(kept);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::abs(std::log(squares[a])) > std::abs(std::log(squares[b])); });
  MatrixXd y(all, std::min(capacity, kept));
  for (Index j = 0; j < y.cols(); ++j) y.col(j) = s * (stretch.eigenvectors().col(order[j]) / std::sqrt(squares[order[j]]));
  return y;
}

}  // namespace

void Recycling::precondition(Vector r) const {
  auto const rows = static_cast<Index>(r.size());
  if (images_.rows() != rows || size() == 0) return;
  Eigen::Map<VectorXd> v(r.data(), rows);
  std::vector<Eigen::VectorXf> parts((rows + block_rows - 1) / block_rows);
  for_row_blocks(rows, [&](Index i, Index first, Index n) {
    parts[i].noalias() = images_.middleRows(first, n).transpose() * v.segment(first, n).cast<float>();
  });
  Eigen::VectorXf c = Eigen::VectorXf::Zero(size());
  for (auto const& part : parts) c += part;
  for_row_blocks(rows, [&](Index, Index first, Index n) {
    Eigen::VectorXf const change = changes_.middleRows(first, n) * c;
    v.segment(first, n) += change.cast<double>();
  });
}

void Recycling::learn(Directions const& w, Directions const& a_w, double cost) {
  if (size() == 0) cost_without_ = cost;
  if (size() > 0 && cost > 0.9 * cost_without_)
    restore({}, {}, cost_without_, 0);
  else if (size() < capacity_ || ++solves_when_full_ % solves_per_lesson == 0)
    learn(w, a_w);
}

void Recycling::learn(Directions const& w, Directions const& a_w) {
  if (images_.rows() != w.rows()) changes_.resize(w.rows(), 0), images_.resize(w.rows(), 0);
  Index const old = size(), all = old + w.cols();
  MatrixXf d(w.rows(), all), image(w.rows(), all);
  d << changes_ + images_, w;
  image << images_, a_w;
  normalise(d, image);
  MatrixXf const y = most_changed(gram(d, d), gram(image, image), capacity_).cast<float>();
  changes_.resize(w.rows(), y.cols());
  images_.resize(w.rows(), y.cols());
  for_row_blocks(w.rows(), [&](Index, Index first, Index n) {
    images_.middleRows(first, n).noalias() = image.middleRows(first, n) * y;
    changes_.middleRows(first, n).noalias() = (d.middleRows(first, n) - image.middleRows(first, n)) * y;
  });
}

}  // namespace asterflow
