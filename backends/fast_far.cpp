#include "backends/fast_far.hpp"

#include "backends/blocks.hpp"
#include "backends/fast_kernel.hpp"

#include <algorithm>
#include <numeric>

namespace asterflow {
namespace {

// Scratch of this thread, grown on demand, aligned for any vector.
template <class Real>
Real* scratch(long n) {
  struct alignas(64) Line {
    char bytes[64];
  };
  static thread_local std::vector<Line> lines;
  std::size_t const wanted = static_cast<std::size_t>(n) * sizeof(Real) / sizeof(Line) + 1;
  if (lines.size() < wanted) lines.resize(wanted);
  return reinterpret_cast<Real*>(lines.data());
}

std::vector<std::uint32_t> heaviest_first(TileView const& tiles, std::size_t n) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  auto const points = [&](std::uint32_t tile) { return tiles.begin[tile + 1] - tiles.begin[tile]; };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return points(a) > points(b); });
  return order;
}

}  // namespace

template <class Real>
FarField<Real>::FarField(FastKernel kernel, FastLoops<Real> const& loops, FastParameters const& parameters)
    : kernel_(kernel),
      loops_(loops),
      components_(n_component(kernel)),
      patches_(kernel, parameters, loops.lanes, loops.tile_y,
               [this](Patch<Real> const& patch, PointArray const& points, std::vector<Range> const& ranges) {
                 return patches_.window().tile(patch, points, ranges);
               }) {}

template <class Real>
void FarField<Real>::set_points(Octree const& tree) {
  tree_ = &tree;
  patches_.set_points(tree);
  views_.clear();
  orders_.clear();
  batches_.clear();
  n_work_ = 0;
  for (Patch<Real> const& patch : patches_.patches()) {
    views_.push_back(patches_.window().view(patch, loops_.lanes));
    auto const n = static_cast<std::size_t>(patch.n_tile());
    orders_.push_back({heaviest_first(views_.back().sources, n), heaviest_first(views_.back().targets, n)});
  }
  for (auto const& batch : patches_.batches()) {
    batches_.push_back({batch.first, batch.last, {}, {}});
    place_work(batches_.back());
  }
}

// Where the patches of a batch find their pieces of the working memory: a spectrum, of which three components come back, and
// behind these the grid of the velocity.
template <class Real>
void FarField<Real>::place_work(Batch& batch) {
  long place = 0;
  for (std::size_t i = batch.first; i < batch.last; ++i) {
    PatchView<Real> const& patch = views_[i];
    long const planes = patch.target_high[2] - patch.target_low[2], rows = patch.target_high[1] - patch.target_low[1];
    long const component = 2L * patch.planes * (patch.modes[0] + 1) * patch.spectrum_row;
    batch.spectrum_begin.push_back(place);
    batch.grid_begin.push_back(place + 3 * component);
    place += std::max(components_ * component, 3 * component + 3 * patch.velocity_row * rows * planes);
  }
  n_work_ = std::max(n_work_, place);
}

template <class Real>
void FarField<Real>::add(Vec3d const* strengths, Vec3d const* normals, Vec3d* velocity, Vec3d* gradient, Real* work) {
  set_strengths(strengths, normals);
  for (Batch const& batch : batches_) run(batch, velocity, gradient, work);
  Vec3d const uniform = patches_.uniform_flow({strengths, tree_->sources().size()});
  for_blocks("FarField::add", static_cast<long>(tree_->targets().size()), [&](long i) { velocity[i] += uniform; });
}

template <class Real>
void FarField<Real>::set_strengths(Vec3d const* strengths, Vec3d const* normals) {
  strengths_.resize(tree_->sources().size() * components_);
  for_blocks("FarField::set_strengths", static_cast<long>(tree_->sources().size()), [&](long i) {
    Vec3d const q = strengths[i], n = components_ == 6 ? normals[i] : Vec3d{};
    double const products[6] = {q.x * n.x, q.y * n.y, q.z * n.z, 0.5 * (q.x * n.y + q.y * n.x),
                                0.5 * (q.x * n.z + q.z * n.x), 0.5 * (q.y * n.z + q.z * n.y)};
    for (int c = 0; c < components_; ++c)
      strengths_[i * components_ + c] = static_cast<Real>(components_ == 6 ? products[c] : q[c]);
  });
}

template <class Real>
void FarField<Real>::for_all(char const* label, Batch const& batch, std::function<long(PatchView<Real> const&)> const& count,
                             std::function<void(PatchView<Real> const&, std::size_t, long)> const& piece) const {
  std::vector<long> begin{0};
  for (std::size_t i = batch.first; i < batch.last; ++i) begin.push_back(begin.back() + count(views_[i]));
  parallel_for(label, begin.back(), [&](long k) {
    long const i = std::upper_bound(begin.begin(), begin.end(), k) - begin.begin() - 1;
    piece(views_[batch.first + i], i, k - begin[i]);
  });
}

template <class Real>
void FarField<Real>::run(Batch const& batch, Vec3d* velocity, Vec3d* gradient, Real* work) {
  using View = PatchView<Real>;
  auto const grid = [&](std::size_t i) { return work + batch.grid_begin[i]; };
  auto const spectrum = [&](std::size_t i) { return work + batch.spectrum_begin[i]; };
  auto const tiles = [](View const& patch) { return static_cast<long>(patch.tiles_y) * patch.tiles_z; };
  auto const window = patches_.window().view();

  for_all("FarField::forward", batch, tiles, [&](View const& patch, std::size_t i, long k) {
    loops_.forward(window, patch, components_, orders_[batch.first + i].sources[k], &tree_->sources().data()->x,
                   strengths_.data(), spectrum(i),
                   scratch<Real>(loops_.forward_scratch(window, patch, components_)));
  });
  for_all("FarField::convolve", batch, [](View const& patch) { return patch.modes[0] + 1L; }, [&](View const& patch, std::size_t i, long kx) {
    loops_.convolve(patch, kernel_, static_cast<int>(kx), spectrum(i), scratch<Real>(loops_.convolve_scratch(patch, components_)));
  });
  for_all("FarField::x_inverse", batch, [](View const& patch) { return static_cast<long>(patch.target_high[2] - patch.target_low[2]); },
          [&](View const& patch, std::size_t i, long z) {
            loops_.x_inverse(patch, patch.target_low[2] + static_cast<int>(z), spectrum(i), grid(i),
                             scratch<Real>(loops_.inverse_scratch(patch)));
          });
  for_all("FarField::interpolate", batch, tiles, [&](View const& patch, std::size_t i, long k) {
    loops_.interpolate(window, patch, orders_[batch.first + i].targets[k], &tree_->targets().data()->x, grid(i),
                       &velocity->x, gradient ? &gradient->x : nullptr);
  });
}

template <class Real>
std::size_t FarField<Real>::memory() const {
  return strengths_.capacity() * sizeof(Real) + patches_.memory();
}

template class FarField<float>;
template class FarField<double>;

}  // namespace asterflow
