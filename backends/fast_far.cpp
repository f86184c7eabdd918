#include "backends/fast_far.hpp"

#include "backends/blocks.hpp"
#include "backends/fast_cover.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_spectrum.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

template <class Real>
FarField<Real>::FarField(FastKernel kernel, FastLoops<Real> const& loops, FastParameters const& parameters,
                         KernelSplit const& split)
    : kernel_(kernel),
      loops_(loops),
      parameters_(parameters),
      split_(split),
      components_(n_component(kernel)),
      window_(parameters.width, parameters.window_shape) {}

template <class Real>
void FarField<Real>::set_points(Octree const& tree) {
  tree_ = &tree;
  patches_.clear();
  batches_.clear();
  views_.clear();
  add_root_patch();
  close_batches(0);
  for (int level = tree.first_level(); level < static_cast<int>(tree.refined().size()); ++level) {
    std::size_t const first = patches_.size();
    add_level_patches(level);
    close_batches(first);
  }
  for (Patch<Real> const& patch : patches_) views_.push_back(window_.view(patch, loops_.lanes));
  for (Batch& batch : batches_) place_work(batch);
}

// Where the patches of a batch find their piece of the working memory.
template <class Real>
void FarField<Real>::place_work(Batch& batch) const {
  batch.grid_begin = batch.spectrum_begin = {0};
  for (std::size_t i = batch.first; i < batch.last; ++i) {
    PatchView<Real> const& patch = views_[i];
    long const planes = patch.target_high[2] - patch.target_low[2], rows = patch.target_high[1] - patch.target_low[1];
    batch.grid_begin.push_back(batch.grid_begin.back() + 3 * patch.velocity_row * rows * planes);
    batch.spectrum_begin.push_back(batch.spectrum_begin.back() +
                                   2L * components_ * patch.nodes[2] * (patch.modes[0] + 1) * patch.spectrum_row);
  }
}

// What all patches of one spacing need: scale, tiles, transforms, symbol.
template <class Real>
void FarField<Real>::set_grid(Patch<Real>& patch, bool is_root) {
  patch.scale = std::pow(patch.spacing, -decay(kernel_));
  patch.set_tiles(loops_);
  for (int d = 0; d < 3; ++d)
    patch.lines[d] = transforms_.try_emplace(patch.nodes[d], patch.nodes[d]).first->second.view();
  patch.symbol = symbol(patch, is_root);
}

// The whole domain in free space: biharmonic function cut off smoothly at the diameter plus the window,
// -(R - r)^2 / (2 R) for r < R; what it lacks, R / 2 + r^2 / (2 R), is a uniform flow
// [after Vico, Greengard & Ferrando 2016].
template <class Real>
void FarField<Real>::add_root_patch() {
  double const cutoff = std::ldexp(1.0, -tree_->first_level());
  double const spacing = cutoff / parameters_.nodes_per_cutoff;
  Vec3d const extent = tree_->extent();
  reach_ = norm(extent) + cutoff;
  Patch<Real> patch;
  double const margin = 0.5 * window_.width() + 1.0;
  patch.spacing = spacing;
  patch.origin = Vec3d{-margin, -margin, -margin} * spacing;
  for (int d = 0; d < 3; ++d) {
    patch.nodes[d] = transform_length(static_cast<int>(std::ceil((extent[d] + reach_ + cutoff) / spacing + 2 * margin)));
    patch.target_low[d] = 0;
    patch.target_high[d] = std::min(patch.nodes[d], static_cast<int>(std::ceil(extent[d] / spacing + 2.0 * margin)) + 1);
  }
  set_grid(patch, true);
  Range const sources{0, static_cast<long>(tree_->sources().size())}, targets{0, static_cast<long>(tree_->targets().size())};
  tile_points(patch, {sources}, {targets});
  patches_.push_back(std::move(patch));
}

template <class Real>
void FarField<Real>::tile_points(Patch<Real>& patch, std::vector<Range> const& sources,
                                 std::vector<Range> const& targets) const {
  patch.sources = window_.tile(patch, tree_->sources(), sources);
  patch.targets = window_.tile(patch, tree_->targets(), targets);
}

template <class Real>
void FarField<Real>::add_level_patches(int level) {
  double const side = std::ldexp(1.0, -level), spacing = 0.5 * side / parameters_.nodes_per_cutoff;
  double const nodes_per_box = side / spacing;
  int const margin = window_.width() / 2 + 1;
  auto const& boxes = tree_->refined()[level];
  auto const rectangles = cover(boxes, nodes_per_box, parameters_.max_nodes((tree_->sources().size() + tree_->targets().size()) / 2));
  std::size_t const first = patches_.size();
  patches_.resize(first + rectangles.size());
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    Patch<Real>& patch = patches_[first + i];
    patch.spacing = spacing;
    for (int d = 0; d < 3; ++d) {
      int const m = rectangles[i].high[d] - rectangles[i].low[d] + 1;
      patch.origin[d] = (rectangles[i].low[d] - 1) * side;
      patch.nodes[d] = transform_length(static_cast<int>(std::ceil((m + 2) * nodes_per_box)));
      patch.target_low[d] = std::max(0, static_cast<int>(nodes_per_box) - margin);
      patch.target_high[d] = std::min(patch.nodes[d], static_cast<int>(std::ceil((m + 1) * nodes_per_box)) + margin);
    }
    set_grid(patch, false);
  }
  parallel_for("FarField::add_level_patches", static_cast<long>(rectangles.size()), [&](long i) {
    Rectangle const& r = rectangles[i];
    std::vector<Range> sources, targets;
    for (Box const* box : r.boxes) targets.push_back(box->targets);
    for (Box const& box : boxes) {
      bool inside = true;
      for (int d = 0; d < 3; ++d) inside = inside && box.place[d] >= r.low[d] - 1 && box.place[d] <= r.high[d] + 1;
      if (inside) sources.push_back(box.sources);
    }
    tile_points(patches_[first + i], sources, targets);
  });
}

template <class Real>
std::shared_ptr<SymbolTable<Real> const> FarField<Real>::symbol(Patch<Real> const& patch, bool is_root) {
  auto const correction = [this](double theta) { return window_.transform(theta); };
  double const cutoff = parameters_.nodes_per_cutoff, band = parameters_.band / cutoff;
  if (is_root) {
    double const reach = reach_ / patch.spacing;
    auto const filter = [&](double k) {
      double const x = k * reach;
      return split_.filter(k * cutoff) * 0.5 * (std::cos(x) + 2.0 - 3.0 * std::sin(x) / x);
    };
    return std::make_shared<SymbolTable<Real>>(make_symbol<Real>(patch.nodes, band, loops_.lanes, filter, correction));
  }
  auto& table = symbols_[{patch.nodes[0], patch.nodes[1], patch.nodes[2]}];
  auto const filter = [&](double k) { return split_.filter(k * cutoff) - split_.filter(2.0 * k * cutoff); };
  if (!table)
    table = std::make_shared<SymbolTable<Real>>(make_symbol<Real>(patch.nodes, band, loops_.lanes, filter, correction));
  return table;
}

template <class Real>
void FarField<Real>::close_batches(std::size_t first) {
  while (first < patches_.size()) {
    std::size_t last = first;
    double total = 0.0;
    while (last < patches_.size() && (last == first || total + double(patches_[last].n_node()) <= parameters_.batch_nodes))
      total += static_cast<double>(patches_[last++].n_node());
    batches_.push_back({first, last, {}, {}});
    first = last;
  }
}

template <class Real>
void FarField<Real>::add(Vec3d const* strengths, Vec3d const* normals, Vec3d* velocity, Vec3d* gradient) {
  set_strengths(strengths, normals);
  long n_grid = 0, n_spectrum = 0;
  for (Batch const& batch : batches_) {
    n_grid = std::max(n_grid, batch.grid_begin.back());
    n_spectrum = std::max(n_spectrum, batch.spectrum_begin.back());
  }
  if (static_cast<long>(grid_.size()) < n_grid) grid_ = std::vector<Real>(n_grid);
  if (static_cast<long>(spectrum_.size()) < n_spectrum) spectrum_ = std::vector<Real>(n_spectrum);
  for (Batch const& batch : batches_) run(batch, velocity, gradient);
  Vec3d const uniform = uniform_flow(strengths);
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
void FarField<Real>::for_all(Batch const& batch, std::function<long(PatchView<Real> const&)> const& count,
                             std::function<void(PatchView<Real> const&, std::size_t, long)> const& piece) const {
  std::vector<long> begin{0};
  for (std::size_t i = batch.first; i < batch.last; ++i) begin.push_back(begin.back() + count(views_[i]));
  parallel_for("FarField::run", begin.back(), [&](long k) {
    long const i = std::upper_bound(begin.begin(), begin.end(), k) - begin.begin() - 1;
    piece(views_[batch.first + i], i, k - begin[i]);
  });
}

template <class Real>
void FarField<Real>::run(Batch const& batch, Vec3d* velocity, Vec3d* gradient) {
  using View = PatchView<Real>;
  auto const grid = [&](std::size_t i) { return grid_.data() + batch.grid_begin[i]; };
  auto const spectrum = [&](std::size_t i) { return spectrum_.data() + batch.spectrum_begin[i]; };
  auto const tiles = [](View const& patch) { return static_cast<long>(patch.tiles_y) * patch.tiles_z; };
  auto const window = window_.view();

  for_all(batch, tiles, [&](View const& patch, std::size_t i, long tile) {
    loops_.forward(window, patch, components_, tile, &tree_->sources().data()->x, strengths_.data(), spectrum(i),
                   scratch<Real>(loops_.forward_scratch(window, patch, components_)));
  });
  for (bool inverse : {false, true}) {
    if (inverse)
      for_all(batch, [](View const& patch) { return 2L * patch.modes[2] + 1; }, [&](View const& patch, std::size_t i, long kz) {
        loops_.y_sweep(patch, kernel_, static_cast<int>(kz) - patch.modes[2], spectrum(i), scratch<Real>(loops_.sweep_scratch(patch)));
      });
    int const n_component = inverse ? 3 : components_;
    for_all(batch, [&](View const& patch) { return n_component * (patch.modes[0] + 1L); }, [&](View const& patch, std::size_t i, long k) {
      int const n_kx = patch.modes[0] + 1;
      loops_.z_sweep(patch, static_cast<int>(k / n_kx), static_cast<int>(k % n_kx), inverse, spectrum(i),
                     scratch<Real>(loops_.sweep_scratch(patch)));
    });
  }
  for_all(batch, [](View const& patch) { return static_cast<long>(patch.target_high[2] - patch.target_low[2]); },
          [&](View const& patch, std::size_t i, long z) {
            loops_.x_inverse(patch, patch.target_low[2] + static_cast<int>(z), spectrum(i), grid(i),
                             scratch<Real>(loops_.sweep_scratch(patch)));
          });
  for_all(batch, tiles, [&](View const& patch, std::size_t i, long tile) {
    loops_.interpolate(window, patch, tile, &tree_->targets().data()->x, grid(i), &velocity->x, gradient ? &gradient->x : nullptr);
  });
}

template <class Real>
Vec3d FarField<Real>::uniform_flow(Vec3d const* strengths) const {
  Vec3d total{};
  if (kernel_ != FastKernel::stokeslet) return total;
  for (std::size_t i = 0; i < tree_->sources().size(); ++i) total += strengths[i];
  return total / (4.0 * M_PI * reach_);
}

template <class Real>
std::size_t FarField<Real>::memory() const {
  std::size_t bytes = (grid_.capacity() + spectrum_.capacity() + strengths_.capacity()) * sizeof(Real);
  for (Patch<Real> const& patch : patches_) bytes += 4 * (patch.sources.index.capacity() + patch.targets.index.capacity());
  for (auto const& [nodes, table] : symbols_) bytes += table->value.capacity() * sizeof(Real);
  return bytes;
}

template class FarField<float>;
template class FarField<double>;

}  // namespace asterflow
