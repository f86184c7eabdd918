// Fast summation: adaptive multilevel Ewald sums. A kernel is a smooth part of cutoff s_0, one band-limited
// difference part per level of an octree, each handled by Fourier transforms on rectangular patches, and a
// local part below the size of the leaves. See docs/summation.md.

#include "backends/fast.hpp"

#include "backends/backend.hpp"
#include "backends/fast_convolution.hpp"
#include "backends/fast_cover.hpp"
#include "backends/fast_grid.hpp"
#include "backends/fast_near.hpp"
#include "backends/fast_plan.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "kernels/list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace asterflow {
namespace {

void require_finite(ConstPoints points, char const* what) {
  for (Vec3d const& p : points)
    if (!std::isfinite(p.x + p.y + p.z) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1e150)
      throw SceneError(std::string("pair sum: ") + what + " " + std::to_string(&p - points.data()) +
                       " is not a finite number below 1e150");
}

// Patches of one level, of bounded total size, handled together.
struct Batch {
  std::size_t first, last;
};

template <class Real>
class Fast final : public Evaluator {
 public:
  Fast(std::string_view kernel, FastParameters const& parameters)
      : kernel_(kernel),
        parameters_(parameters),
        split_(parameters.split_shape),
        components_(kernel == "stresslet" ? 6 : 3),
        convolution_(kernel_, components_) {}

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    ASTERFLOW_REQUIRE(normals.size() == (components_ == 6 ? sources.size() : 0));
    require_finite(sources, "source");
    require_finite(targets, "target");
    require_finite(normals, "normal");
    n_source_ = sources.size();
    n_target_ = targets.size();
    patches_.clear();
    batches_.clear();
    direct_.reset();
    if (n_source_ == 0 || n_target_ == 0) return;
    if (static_cast<long>(n_source_ + n_target_) > 2 * parameters_.capacity)
      tree_ = best_octree(sources, targets, parameters_, components_);
    else
      tree_.reset();
    if (!tree_ || tree_->refined().empty()) {
      direct_ = make_direct(kernel_, parameters_.accuracy);
      return direct_->set_points(sources, targets, normals);
    }
    make_tables();
    near_->set_points(*tree_, sources, targets);
    normals_.clear();
    for (std::uint32_t i : tree_->source_order())
      if (!normals.empty()) normals_.push_back(normals[i]);
    make_patches();
  }

  void add_velocity(ConstPoints strengths, Points velocity) override {
    ASTERFLOW_REQUIRE(strengths.size() == n_source_ && velocity.size() == n_target_);
    require_finite(strengths, "strength");
    if (n_source_ == 0 || n_target_ == 0) return;
    if (direct_) return direct_->add_velocity(strengths, velocity);
    double largest = 0.0;
    for (Vec3d const& q : strengths) largest = std::max({largest, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    if (largest == 0.0) return;
    PointArray sorted(n_source_);
    for (std::size_t i = 0; i < n_source_; ++i) sorted[i] = strengths[tree_->source_order()[i]] / largest;
    PointArray smooth(n_target_), local(n_target_);
    set_grid_strengths(sorted);
    for (Batch const& batch : batches_) run_batch(batch, smooth.data());
    near_->set_strengths(sorted.data(), normals_.empty() ? nullptr : normals_.data());
    parallel_for("Fast::near", near_->n_items(), [&](long i) { near_->add(i, local.data()); });
    Vec3d const uniform = uniform_flow(sorted);
    double const scale = largest / (kernel_ == "stokeslet" ? tree_->side() : tree_->side() * tree_->side());
    for (std::size_t i = 0; i < n_target_; ++i)
      velocity[tree_->target_order()[i]] += scale * (smooth[i] + local[i] / (8.0 * M_PI) + uniform);
  }

  std::string_view backend() const override { return "fast"; }
  std::size_t memory() const override {
    if (direct_) return direct_->memory();
    std::size_t bytes = near_->memory() + (grid_.capacity() + spectrum_.capacity() + strengths_.capacity()) * sizeof(Real);
    bytes += 40 * (n_source_ + n_target_);
    for (Patch<Real> const& patch : patches_)
      bytes += 4 * (patch.sources.index.capacity() + patch.targets.index.capacity());
    return bytes;
  }

 private:
  // --- geometry
  void make_tables();
  void make_patches();
  void add_root_patch();
  void add_level_patches(int level);
  std::shared_ptr<SymbolTable<Real> const> symbol(Patch<Real> const& patch, bool root, double reach);
  void close_batch(std::size_t first);

  // --- sums
  void set_grid_strengths(PointArray const& sorted);
  void run_batch(Batch const& batch, Vec3d* velocity);
  Vec3d uniform_flow(PointArray const& sorted) const;

  std::string kernel_;
  FastParameters parameters_;
  KernelSplit split_;
  int components_;
  GridConvolution<Real> convolution_;
  std::unique_ptr<GridWindow<Real>> window_;  // made for the first points that need them
  std::unique_ptr<NearField<Real>> near_;

  std::size_t n_source_ = 0, n_target_ = 0;
  std::unique_ptr<Evaluator> direct_;  // in place of everything else where the points are few
  std::unique_ptr<Octree> tree_;
  PointArray normals_;  // in the order of the tree
  double reach_ = 0.0;  // distance up to which the root's kernel is that of free space
  std::vector<Patch<Real>> patches_;
  std::vector<Batch> batches_;
  std::map<std::array<int, 4>, std::shared_ptr<SymbolTable<Real> const>> symbols_;
  std::vector<Real> strengths_, grid_, spectrum_;
};

template <class Real>
void Fast<Real>::make_tables() {
  if (window_) return;
  window_ = std::make_unique<GridWindow<Real>>(parameters_.width, parameters_.window_shape);
  near_ = std::make_unique<NearField<Real>>(kernel_, split_.local_part(kernel_, parameters_.local_tolerance),
                                            parameters_.refinement_steps);
}

template <class Real>
void Fast<Real>::make_patches() {
  add_root_patch();
  close_batch(0);
  for (int level = tree_->first_level(); level < static_cast<int>(tree_->refined().size()); ++level) {
    std::size_t const first = patches_.size();
    add_level_patches(level);
    close_batch(first);
  }
}

// The whole domain in free space: biharmonic function cut off smoothly at the diameter plus the window,
// -(R - r)^2 / (2 R) for r < R; what it lacks, R / 2 + r^2 / (2 R), is a uniform flow
// [after Vico, Greengard & Ferrando 2016].
template <class Real>
void Fast<Real>::add_root_patch() {
  double const cutoff = std::ldexp(1.0, -tree_->first_level());
  double const spacing = cutoff / parameters_.nodes_per_cutoff;
  Vec3d const extent = tree_->extent();
  reach_ = norm(extent) + cutoff;
  Patch<Real> patch;
  double const margin = 0.5 * window_->width() + 1.0;
  patch.spacing = spacing;
  patch.origin = Vec3d{-margin, -margin, -margin} * spacing;
  for (int d = 0; d < 3; ++d) {
    patch.nodes[d] = transform_length(static_cast<int>(std::ceil((extent[d] + reach_ + cutoff) / spacing + 2 * margin)));
    patch.target_low[d] = 0;
    patch.target_high[d] = std::min(patch.nodes[d], static_cast<int>(std::ceil(extent[d] / spacing + 2.0 * margin)) + 1);
  }
  patch.scale = kernel_ == "stokeslet" ? 1.0 / spacing : 1.0 / (spacing * spacing);
  patch.tiles_y = std::max(1, patch.nodes[1] / Patch<Real>::tile);
  patch.tiles_z = std::max(1, patch.nodes[2] / Patch<Real>::tile);
  patch.sources = window_->tile(patch, tree_->sources(), {{0, static_cast<long>(n_source_)}});
  patch.targets = window_->tile(patch, tree_->targets(), {{0, static_cast<long>(n_target_)}});
  patch.symbol = symbol(patch, true, reach_ / spacing);
  patches_.push_back(std::move(patch));
}

template <class Real>
void Fast<Real>::add_level_patches(int level) {
  double const side = std::ldexp(1.0, -level), spacing = 0.5 * side / parameters_.nodes_per_cutoff;
  double const nodes_per_box = side / spacing;
  auto const rectangles = cover(tree_->refined()[level], nodes_per_box, parameters_.max_nodes);
  std::size_t const first = patches_.size();
  patches_.resize(first + rectangles.size());
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    Patch<Real>& patch = patches_[first + i];
    patch.spacing = spacing;
    patch.scale = kernel_ == "stokeslet" ? 1.0 / spacing : 1.0 / (spacing * spacing);
    int const margin = window_->width() / 2 + 1;
    for (int d = 0; d < 3; ++d) {
      int const m = rectangles[i].high[d] - rectangles[i].low[d] + 1;
      patch.origin[d] = (rectangles[i].low[d] - 1) * side;
      patch.nodes[d] = transform_length(static_cast<int>(std::ceil((m + 2) * nodes_per_box)));
      patch.target_low[d] = std::max(0, static_cast<int>(nodes_per_box) - margin);
      patch.target_high[d] = std::min(patch.nodes[d], static_cast<int>(std::ceil((m + 1) * nodes_per_box)) + margin);
    }
    patch.tiles_y = std::max(1, patch.nodes[1] / Patch<Real>::tile);
    patch.tiles_z = std::max(1, patch.nodes[2] / Patch<Real>::tile);
    patch.symbol = symbol(patch, false, 0.0);
  }
  parallel_for("Fast::add_level_patches", static_cast<long>(rectangles.size()), [&](long i) {
    Rectangle const& r = rectangles[i];
    std::vector<Range> sources, targets;
    for (Box const* box : r.boxes) targets.push_back(box->targets);
    for (Box const& box : tree_->refined()[level]) {
      bool inside = true;
      for (int d = 0; d < 3; ++d) inside = inside && box.place[d] >= r.low[d] - 1 && box.place[d] <= r.high[d] + 1;
      if (inside) sources.push_back(box.sources);
    }
    Patch<Real>& patch = patches_[first + i];
    patch.sources = window_->tile(patch, tree_->sources(), sources);
    patch.targets = window_->tile(patch, tree_->targets(), targets);
  });
}

template <class Real>
std::shared_ptr<SymbolTable<Real> const> Fast<Real>::symbol(Patch<Real> const& patch, bool root, double reach) {
  for (int n : patch.nodes) convolution_.prepare(n);
  auto const correction = [&](double theta) { return window_->transform(theta); };
  double const cutoff = parameters_.nodes_per_cutoff, band = parameters_.band / cutoff;
  if (root) {
    auto const filter = [&](double k) {
      double const x = k * reach;
      return split_.filter(k * cutoff) * 0.5 * (std::cos(x) + 2.0 - 3.0 * std::sin(x) / x);
    };
    return std::make_shared<SymbolTable<Real>>(make_symbol<Real>(patch.nodes, band, filter, correction));
  }
  auto& table = symbols_[{patch.nodes[0], patch.nodes[1], patch.nodes[2], 0}];
  auto const filter = [&](double k) { return split_.filter(k * cutoff) - split_.filter(2.0 * k * cutoff); };
  if (!table) table = std::make_shared<SymbolTable<Real>>(make_symbol<Real>(patch.nodes, band, filter, correction));
  return table;
}

template <class Real>
void Fast<Real>::close_batch(std::size_t first) {
  auto const nodes = [&](std::size_t i) {
    return static_cast<double>(patches_[i].nodes[0]) * patches_[i].nodes[1] * patches_[i].nodes[2];
  };
  while (first < patches_.size()) {
    std::size_t last = first;
    double total = 0.0;
    while (last < patches_.size() && (last == first || total + nodes(last) <= parameters_.max_nodes)) total += nodes(last++);
    batches_.push_back({first, last});
    first = last;
  }
}

template <class Real>
void Fast<Real>::set_grid_strengths(PointArray const& sorted) {
  strengths_.resize(sorted.size() * components_);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    Vec3d const q = sorted[i];
    Real* const s = strengths_.data() + i * components_;
    if (components_ == 3) {
      for (int d = 0; d < 3; ++d) s[d] = static_cast<Real>(q[d]);
    } else {
      Vec3d const n = normals_[i];
      double const products[6] = {q.x * n.x, q.y * n.y, q.z * n.z, 0.5 * (q.x * n.y + q.y * n.x),
                                  0.5 * (q.x * n.z + q.z * n.x), 0.5 * (q.y * n.z + q.z * n.y)};
      for (int c = 0; c < 6; ++c) s[c] = static_cast<Real>(products[c]);
    }
  }
}

template <class Real>
void Fast<Real>::run_batch(Batch const& batch, Vec3d* velocity) {
  std::vector<long> grid_begin, spectrum_begin;
  long grid_size = 0, spectrum_size = 0;
  for (std::size_t i = batch.first; i < batch.last; ++i) {
    Patch<Real> const& patch = patches_[i];
    grid_begin.push_back(grid_size);
    spectrum_begin.push_back(spectrum_size);
    grid_size += window_->row(patch) * components_ * patch.nodes[1] * patch.nodes[2];
    spectrum_size += convolution_.spectrum_size(patch);
  }
  if (static_cast<long>(grid_.size()) < grid_size) grid_.resize(grid_size);
  if (static_cast<long>(spectrum_.size()) < spectrum_size) spectrum_.resize(spectrum_size);
  // Runs piece(patch number in the batch, item) for all items of all patches.
  auto const for_all = [&](auto const& count, auto const& piece) {
    std::vector<long> begin{0};
    for (std::size_t i = batch.first; i < batch.last; ++i) begin.push_back(begin.back() + count(patches_[i]));
    parallel_for("Fast::run_batch", begin.back(), [&](long k) {
      long const i = std::upper_bound(begin.begin(), begin.end(), k) - begin.begin() - 1;
      piece(patches_[batch.first + i], i, k - begin[i]);
    });
  };
  auto const tiles = [](Patch<Real> const& patch) { return static_cast<long>(patch.tiles_y) * patch.tiles_z; };
  for_all(tiles, [&](Patch<Real> const& patch, long i, long item) {
    window_->spread(patch, item, tree_->sources(), strengths_.data(), components_, grid_.data() + grid_begin[i]);
  });
  for (Sweep sweep : {Sweep::x_forward, Sweep::z_forward, Sweep::y_and_symbol, Sweep::z_inverse, Sweep::x_inverse})
    for_all([&](Patch<Real> const& patch) { return convolution_.n_items(patch, sweep); },
            [&](Patch<Real> const& patch, long i, long item) {
              convolution_.run(patch, sweep, item, window_->row(patch), grid_.data() + grid_begin[i],
                               spectrum_.data() + spectrum_begin[i]);
            });
  for_all(tiles, [&](Patch<Real> const& patch, long i, long item) {
    window_->interpolate(patch, item, tree_->targets(), grid_.data() + grid_begin[i], components_, velocity);
  });
}

template <class Real>
Vec3d Fast<Real>::uniform_flow(PointArray const& sorted) const {
  Vec3d total{};
  if (kernel_ != "stokeslet" || patches_.empty()) return total;
  for (Vec3d const& f : sorted) total += f;
  return total / (4.0 * M_PI * reach_);
}

}  // namespace

std::unique_ptr<Evaluator> make_fast(std::string_view kernel, FastParameters const& parameters) {
  if (parameters.single) return std::make_unique<Fast<float>>(kernel, parameters);
  return std::make_unique<Fast<double>>(kernel, parameters);
}

std::unique_ptr<Evaluator> make_fast(std::string_view kernel, double accuracy) {
  if (accuracy < 1e-12) return make_direct(kernel, accuracy);
  return make_fast(kernel, fast_parameters(kernel, accuracy));
}

}  // namespace asterflow
