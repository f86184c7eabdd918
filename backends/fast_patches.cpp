#include "backends/fast_patches.hpp"

#include "backends/fast_cover.hpp"
#include "backends/fast_crowding.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_spectrum.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

template <class Real>
FarPatches<Real>::FarPatches(FastKernel kernel, FastParameters const& parameters, int lanes, int tile_y,
                             Tiling tiling)
    : kernel_(kernel),
      parameters_(parameters),
      split_(parameters.split_shape),
      lanes_(lanes),
      tile_y_(tile_y),
      tiling_(std::move(tiling)),
      window_(parameters.width, parameters.window_shape, parameters.sums_in_double) {}

template <class Real>
void FarPatches<Real>::set_points(Octree const& tree) {
  patches_.clear();
  batches_.clear();
  add_root_patch(tree);
  close_batches(0);
  for (int level = tree.first_level(); level < static_cast<int>(tree.boxes().refined().size()); ++level) {
    std::size_t const first = patches_.size();
    add_level_patches(tree, level);
    close_batches(first);
  }
}

// What all patches of one spacing need: scale, transforms, symbol.
template <class Real>
void FarPatches<Real>::set_grid(Octree const& tree, Patch<Real>& patch, bool is_root) {
  patch.corner = tree.corner();
  patch.unit_side = tree.unit_side();
  patch.scale = std::pow(patch.spacing, -decay(kernel_));
  for (int d = 0; d < 3; ++d)
    patch.lines[d] = transforms_.try_emplace(patch.nodes[d], patch.nodes[d]).first->second.view();
  patch.symbol = symbol(patch, is_root);
}

// The whole domain in free space: biharmonic function cut off smoothly at the diameter plus the window,
// -(R - r)^2 / (2 R) for r < R; what it lacks, R / 2 + r^2 / (2 R), is a uniform flow
// [after Vico, Greengard & Ferrando 2016].
template <class Real>
void FarPatches<Real>::add_root_patch(Octree const& tree) {
  double const cutoff = std::ldexp(1.0, -tree.first_level());
  double const spacing = cutoff / parameters_.nodes_per_cutoff;
  Vec3d const extent = tree.extent();
  reach_ = norm(extent) + cutoff;
  Patch<Real> patch;
  double const margin = 0.5 * window_.width() + 1.0;
  patch.spacing = spacing;
  patch.origin = Vec3d{-margin, -margin, -margin} * spacing;
  for (int d = 0; d < 3; ++d)
    patch.nodes[d] = transform_length(static_cast<int>(std::ceil((extent[d] + reach_ + cutoff) / spacing + 2 * margin)));
  set_grid(tree, patch, true);
  patches_.push_back(std::move(patch));
  tile_points(tree, 0, {{{0, static_cast<long>(tree.sources().size())}}}, {{{0, static_cast<long>(tree.targets().size())}}});
}

// Of the patches from `first` on, each with its ranges of sources and targets.
template <class Real>
void FarPatches<Real>::tile_points(Octree const& tree, std::size_t first, std::vector<std::vector<Range>> const& sources,
                                   std::vector<std::vector<Range>> const& targets) {
  parallel_for("FarPatches::reach", static_cast<long>(2 * sources.size()), [&](long i) {
    std::size_t const k = i / 2;
    Patch<Real>& patch = patches_[first + k];
    if (i % 2 == 0)
      window_.find_reach(patch, tree.sources(), sources[k], patch.source_low, patch.source_high);
    else
      window_.find_reach(patch, tree.targets(), targets[k], patch.target_low, patch.target_high);
  });
  for (std::size_t k = first; k < patches_.size(); ++k) patches_[k].set_tiles(tile_y_, window_.width());
  parallel_for("FarPatches::tile_points", static_cast<long>(2 * sources.size()), [&](long i) {
    std::size_t const k = i / 2;
    Patch<Real>& patch = patches_[first + k];
    if (i % 2 == 0)
      patch.sources = tiling_(patch, tree.sources(), sources[k]);
    else
      patch.targets = tiling_(patch, tree.targets(), targets[k]);
  });
  if (sizeof(Real) > sizeof(float) || !parameters_.sums_in_double) return;
  for (std::size_t k = 0; k < sources.size(); ++k)
    patches_[first + k].crowding = crowding(window_, patches_[first + k], tree.sources(), sources[k]);
}

template <class Real>
void FarPatches<Real>::add_level_patches(Octree const& tree, int level) {
  double const side = std::ldexp(1.0, -level), spacing = 0.5 * side / parameters_.nodes_per_cutoff;
  double const nodes_per_box = side / spacing;
  auto const& boxes = tree.boxes().refined()[level].boxes();
  std::size_t const n_point = (tree.sources().size() + tree.targets().size()) / 2;
  std::vector<Box const*> all;
  for (Box const& box : boxes) all.push_back(&box);
  auto const rectangles = cover(std::move(all), nodes_per_box, parameters_.max_nodes(n_point));
  std::size_t const first = patches_.size();
  patches_.resize(first + rectangles.size());
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    Patch<Real>& patch = patches_[first + i];
    patch.spacing = spacing;
    for (int d = 0; d < 3; ++d) {
      int const m = rectangles[i].high[d] - rectangles[i].low[d] + 1;
      patch.origin[d] = (rectangles[i].low[d] - 1) * side;
      patch.nodes[d] = transform_length(static_cast<int>(std::ceil((m + 2) * nodes_per_box)));
    }
    set_grid(tree, patch, false);
  }
  std::vector<std::vector<Range>> sources(rectangles.size()), targets(rectangles.size());
  parallel_for("FarPatches::add_level_patches", static_cast<long>(rectangles.size()), [&](long i) {
    Rectangle const& r = rectangles[i];
    for (Box const* box : r.boxes) targets[i].push_back(box->targets);
    for (Box const& box : boxes) {
      bool inside = true;
      for (int d = 0; d < 3; ++d) inside = inside && box.place[d] >= r.low[d] - 1 && box.place[d] <= r.high[d] + 1;
      if (inside) sources[i].push_back(box.sources);
    }
  });
  tile_points(tree, first, sources, targets);
}

template <class Real>
std::shared_ptr<SymbolTable<Real> const> FarPatches<Real>::symbol(Patch<Real> const& patch, bool is_root) {
  auto const correction = [this](double theta) { return window_.transform(theta); };
  double const cutoff = parameters_.nodes_per_cutoff, band = parameters_.band / cutoff;
  if (is_root) {
    double const reach = reach_ / patch.spacing;
    auto const filter = [&](double k) {
      double const x = k * reach;
      return split_.filter(k * cutoff) * 0.5 * (std::cos(x) + 2.0 - 3.0 * std::sin(x) / x);
    };
    return std::make_shared<SymbolTable<Real>>(make_symbol<Real>(patch.nodes, band, lanes_, filter, correction));
  }
  auto& table = symbols_[{patch.nodes[0], patch.nodes[1], patch.nodes[2]}];
  auto const filter = [&](double k) { return split_.filter(k * cutoff) - split_.filter(2.0 * k * cutoff); };
  if (!table)
    table = std::make_shared<SymbolTable<Real>>(make_symbol<Real>(patch.nodes, band, lanes_, filter, correction));
  return table;
}

template <class Real>
void FarPatches<Real>::close_batches(std::size_t first) {
  while (first < patches_.size()) {
    std::size_t last = first;
    double total = 0.0;
    while (last < patches_.size() && (last == first || total + double(patches_[last].n_node()) <= parameters_.batch_nodes))
      total += static_cast<double>(patches_[last++].n_node());
    batches_.push_back({first, last});
    first = last;
  }
}

template <class Real>
Vec3d FarPatches<Real>::uniform_flow(ConstPoints strengths) const {
  Vec3d total{};
  if (kernel_ != FastKernel::stokeslet) return total;
  for (Vec3d const& f : strengths) total += f;
  return total / (4.0 * M_PI * reach_);
}

template <class Real>
std::size_t FarPatches<Real>::memory() const {
  std::size_t bytes = 0;
  for (Patch<Real> const& patch : patches_) bytes += 4 * (patch.sources.index.capacity() + patch.targets.index.capacity());
  for (auto const& [nodes, table] : symbols_) bytes += table->value.capacity() * sizeof(Real);
  return bytes;
}

template class FarPatches<float>;
template class FarPatches<double>;

}  // namespace asterflow
