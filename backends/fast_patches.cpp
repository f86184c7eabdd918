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

template <class Real>
void FarPatches<Real>::Members::find_boxes(Octree const& tree) {
  source_box = {tree.sources(), sources};
  target_box = {tree.targets(), targets};
}

// The whole domain in free space: biharmonic function cut off smoothly at the largest distance of two points plus the window,
// -(R - r)^2 / (2 R) for r < R; what it lacks, R / 2 + r^2 / (2 R), is a uniform flow
// [after Vico, Greengard & Ferrando 2016].
template <class Real>
void FarPatches<Real>::add_root_patch(Octree const& tree) {
  double const cutoff = std::ldexp(1.0, -tree.first_level());
  double const spacing = cutoff / parameters_.nodes_per_cutoff;
  Vec3d const extent = tree.extent();
  reach_ = tree.largest_distance() + cutoff;
  Patch<Real> patch;
  double const margin = 0.5 * window_.width() + 1.0;
  patch.spacing = spacing;
  patch.origin = Vec3d{-margin, -margin, -margin} * spacing;
  for (int d = 0; d < 3; ++d)
    patch.nodes[d] = transform_length(static_cast<int>(std::ceil((extent[d] + reach_ + cutoff) / spacing + 2 * margin)));
  set_grid(tree, patch, true);
  patches_.push_back(std::move(patch));
  std::vector<Members> all(1);
  all[0].sources = {{0, static_cast<long>(tree.sources().size())}};
  all[0].targets = {{0, static_cast<long>(tree.targets().size())}};
  all[0].find_boxes(tree);
  tile_points(tree, 0, all);
}

// Of the patches from `first` on.
template <class Real>
void FarPatches<Real>::tile_points(Octree const& tree, std::size_t first, std::vector<Members> const& members) {
  for (std::size_t k = 0; k < members.size(); ++k) {
    Patch<Real>& patch = patches_[first + k];
    window_.find_reach(patch, members[k].source_box, patch.source_low, patch.source_high);
    window_.find_reach(patch, members[k].target_box, patch.target_low, patch.target_high);
    patch.set_tiles(tile_y_, window_.width());
  }
  parallel_for("FarPatches::tile_points", static_cast<long>(2 * members.size()), [&](long i) {
    std::size_t const k = i / 2;
    Patch<Real>& patch = patches_[first + k];
    if (i % 2 == 0)
      patch.sources = tiling_(patch, tree.sources(), members[k].sources);
    else
      patch.targets = tiling_(patch, tree.targets(), members[k].targets);
  });
  if (sizeof(Real) > sizeof(float) || !parameters_.sums_in_double) return;
  for (std::size_t k = 0; k < members.size(); ++k)
    patches_[first + k].crowding = crowding(window_, patches_[first + k], tree.sources(), members[k].sources);
}

// Each as small as its points allow: the kernel of a level is zero beyond the side of its boxes, so that periodic images have to
// be at least that far away.
template <class Real>
void FarPatches<Real>::add_level_patches(Octree const& tree, int level) {
  double const side = std::ldexp(1.0, -level), spacing = 0.5 * side / parameters_.nodes_per_cutoff;
  auto const& boxes = tree.boxes().refined()[level].boxes();
  std::size_t const n_point = (tree.sources().size() + tree.targets().size()) / 2;
  std::vector<Box const*> all;
  for (Box const& box : boxes) all.push_back(&box);
  auto const rectangles = cover(std::move(all), side / spacing, parameters_.max_nodes(n_point));
  std::vector<Members> members(rectangles.size());
  parallel_for("FarPatches::add_level_patches", static_cast<long>(rectangles.size()), [&](long i) {
    Rectangle const& r = rectangles[i];
    for (Box const* box : r.boxes) members[i].targets.push_back(box->targets);
    for (Box const& box : boxes) {
      bool inside = true;
      for (int d = 0; d < 3; ++d) inside = inside && box.place[d] >= r.low[d] - 1 && box.place[d] <= r.high[d] + 1;
      if (inside) members[i].sources.push_back(box.sources);
    }
    members[i].find_boxes(tree);
  });
  std::erase_if(members, [](Members const& m) { return m.source_box.is_empty() || m.target_box.is_empty(); });
  std::size_t const first = patches_.size();
  patches_.resize(first + members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    Patch<Real>& patch = patches_[first + i];
    patch.spacing = spacing;
    double const margin = 0.5 * window_.width();
    Vec3d const source_low = tree.normalised(members[i].source_box.low), source_high = tree.normalised(members[i].source_box.high);
    Vec3d const target_low = tree.normalised(members[i].target_box.low), target_high = tree.normalised(members[i].target_box.high);
    for (int d = 0; d < 3; ++d) {
      double const low = std::min(source_low[d], target_low[d]), high = std::max(source_high[d], target_high[d]);
      double const farthest = std::max(source_high[d] - target_low[d], target_high[d] - source_low[d]);
      patch.origin[d] = low - margin * spacing;
      patch.nodes[d] = transform_length(static_cast<int>(std::ceil(std::max((farthest + side) / spacing, (high - low) / spacing + 2.0 * margin + 2.0))));
    }
    set_grid(tree, patch, false);
  }
  tile_points(tree, first, members);
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
