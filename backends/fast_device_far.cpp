#include "backends/fast_device_far.hpp"

#include "backends/fast_device_fourier.hpp"
#include "backends/fast_device_grid.hpp"
#include "backends/fast_kernel.hpp"

#include "backends/fast_symbol.inl"

#include <algorithm>
#include <cmath>
#include <map>

namespace asterflow {
namespace {

constexpr int threads = default_space_is_host ? 1 : 64;
constexpr int lanes = default_space_is_host ? 1 : 16;  // for the nodes of a window in one direction

// Nodes of patches handled together: enough to occupy a device.
constexpr double batch_nodes = default_space_is_host ? 1e6 : 2e7;

FastParameters for_device(FastParameters parameters) {
  parameters.batch_nodes = batch_nodes;
  return parameters;
}

// Sorts points by the block of the patch that has the first node of their window.
template <class Real>
TiledPoints sort_into_blocks(GridWindow<Real> const& window, Patch<Real> const& patch, PointArray const& points,
                             std::vector<Range> const& ranges) {
  PatchView<Real> const grid = window.view(patch, 1);
  long blocks[3], n_block = 1;
  for (int d = 0; d < 3; ++d) n_block *= blocks[d] = (patch.nodes[d] + block_edge - 1) / block_edge;
  auto const place = [&](Vec3d const& x, int d) {
    return wrapped_node(static_cast<int>(std::floor((x[d] - grid.corner[d]) * grid.to_nodes)), patch.nodes[d]) / block_edge;
  };
  TiledPoints sorted;
  sorted.tile_begin.assign(n_block + 1, 0);
  std::vector<long> block_of;
  for (Range const& range : ranges)
    for (long i = range.begin; i < range.end; ++i) {
      block_of.push_back((place(points[i], 2) * blocks[1] + place(points[i], 1)) * blocks[0] + place(points[i], 0));
      ++sorted.tile_begin[block_of.back() + 1];
    }
  for (long i = 0; i < n_block; ++i) sorted.tile_begin[i + 1] += sorted.tile_begin[i];
  std::vector<long> next(sorted.tile_begin.begin(), sorted.tile_begin.end() - 1);
  sorted.index.resize(block_of.size());
  long k = 0;
  for (Range const& range : ranges)
    for (long i = range.begin; i < range.end; ++i, ++k) sorted.index[next[block_of[k]]++] = static_cast<std::uint32_t>(i);
  return sorted;
}

// scratch: numbers of a team's scratch memory.
template <class Real, class Functor>
void launch_teams(char const* label, DevicePieces const& pieces, int n_thread, int n_lane, int level, long scratch,
                  Functor const& functor) {
  if (pieces.total == 0) return;
  DeviceTeamPolicy policy(DeviceSpace(), static_cast<int>(pieces.total), n_thread, n_lane);
  policy.set_scratch_size(level, Kokkos::PerTeam(static_cast<int>(DeviceScratch<Real>::shmem_size(scratch))));
  Kokkos::parallel_for(label, policy, functor);
}

}  // namespace

template <class Real>
DeviceFar<Real>::DeviceFar(FastKernel kernel, FastParameters const& parameters)
    : kernel_(kernel),
      components_(n_component(kernel)),
      patches_(kernel, for_device(parameters), 1, block_edge,
               [this](Patch<Real> const& patch, PointArray const& points, std::vector<Range> const& ranges) {
                 return sort_into_blocks(patches_.window(), patch, points, ranges);
               }) {
  WindowView<Real> const window = patches_.window().view();
  tables_.window.width = window.width;
  tables_.window.padded = window.padded;
  tables_.window.degree = window.degree;
  send(tables_.window.coefficients, window.coefficients, 2UL * (window.degree + 1) * window.padded, "window");
}

template <class Real>
void DeviceFar<Real>::set_points(Octree const& tree, ConstPoints normals) {
  patches_.set_points(tree);
  n_source_ = static_cast<long>(tree.sources().size());
  send(tables_.source_points, &tree.sources().data()->x, 3 * tree.sources().size(), "source_points");
  send(tables_.target_points, &tree.targets().data()->x, 3 * tree.targets().size(), "target_points");
  if (!normals.empty()) send(normals_, &normals.data()->x, 3 * normals.size(), "normals");
  grow(tables_.strengths, components_ * tree.sources().size(), "strengths");
  send_patches();
  batches_.clear();
  for (auto const& batch : patches_.batches()) add_batch(batch.first, batch.last);
  send(tables_.patches, host_patches_, "patches");
}

template <class Real>
DeviceLine DeviceFar<Real>::line(int length, std::vector<Real>& twiddles) {
  LineTransform<Real> const transform(length);
  LineView<Real> const view = transform.view();
  DeviceLine line;
  line.length = length;
  line.n_radix = view.n_radix;
  line.twiddles = static_cast<long>(twiddles.size());
  long n_twiddle = 0;
  for (int i = 0, n = length; i < view.n_radix; ++i) {
    line.radices[i] = view.radices[i];
    n_twiddle += 2L * (view.radices[i] - 1) * (n / view.radices[i]);
    n /= view.radices[i];
  }
  twiddles.insert(twiddles.end(), view.twiddles, view.twiddles + n_twiddle);
  return line;
}

// A table as [|jz|, |jy|, jx]: neighbours in x are read together.
template <class Real>
void append_by_rows_of_x(SymbolTable<Real> const& table, std::vector<Real>& symbols) {
  for (int jz = 0; jz <= table.modes[2]; ++jz)
    for (int jy = 0; jy <= table.modes[1]; ++jy)
      for (int jx = 0; jx <= table.modes[0]; ++jx)
        symbols.push_back(table.value[(static_cast<std::size_t>(jx) * (table.modes[1] + 1) + jy) * table.stride + jz]);
}

template <class Real>
void DeviceFar<Real>::send_patches() {
  std::vector<long> first_sources;
  std::vector<std::uint32_t> sources, targets;
  std::vector<Real> symbols, twiddles;
  std::map<SymbolTable<Real> const*, long> known_symbols;
  std::map<int, DeviceLine> known_lines;
  host_patches_.clear();
  for (Patch<Real> const& patch : patches_.patches()) {
    PatchView<Real> const view = patches_.window().view(patch, 1);
    DevicePatch p;
    for (int d = 0; d < 3; ++d) {
      p.nodes[d] = view.nodes[d];
      p.blocks[d] = (view.nodes[d] + block_edge - 1) / block_edge;
      p.modes[d] = view.modes[d];
      p.corner[d] = view.corner[d];
      p.target_low[d] = view.target_low[d];
      p.target_high[d] = view.target_high[d];
      if (!known_lines.contains(p.nodes[d])) known_lines[p.nodes[d]] = line(p.nodes[d], twiddles);
      p.lines[d] = known_lines[p.nodes[d]];
    }
    p.to_nodes = view.to_nodes;
    p.scale = view.scale;
    p.slope_scale = view.slope_scale;
    auto const [symbol, is_new] = known_symbols.try_emplace(patch.symbol.get(), static_cast<long>(symbols.size()));
    if (is_new) append_by_rows_of_x(*patch.symbol, symbols);
    p.symbol = symbol->second;
    p.source_begin = static_cast<long>(first_sources.size());
    for (long first : patch.sources.tile_begin) first_sources.push_back(first + static_cast<long>(sources.size()));
    sources.insert(sources.end(), patch.sources.index.begin(), patch.sources.index.end());
    p.target_begin = static_cast<long>(targets.size());
    p.n_target = static_cast<long>(patch.targets.index.size());
    targets.insert(targets.end(), patch.targets.index.begin(), patch.targets.index.end());
    host_patches_.push_back(p);
  }
  send(tables_.first_sources, first_sources, "first_sources");
  send(tables_.sources, sources, "sources");
  send(tables_.targets, targets, "targets");
  send(tables_.symbols, symbols, "symbols");
  send(tables_.twiddles, twiddles, "twiddles");
}

// Patches [first, last): their places in the working memory, and the pieces of their work.
template <class Real>
void DeviceFar<Real>::add_batch(std::size_t first, std::size_t last) {
  int const most = std::max(3, components_);
  long n_grid = 0, n_spectrum = 0;
  for (std::size_t i = first; i < last; ++i) {
    DevicePatch& patch = host_patches_[i];
    patch.grid = n_grid;
    patch.spectrum = n_spectrum;
    n_grid += most * patch.n_node();
    n_spectrum += most * patch.n_mode();
  }
  grow(tables_.grid, n_grid, "grid");
  grow(tables_.spectrum, 2 * n_spectrum, "spectrum");
  Batch batch;
  auto const blocks = [](DevicePatch const& patch, int) { return patch.n_block(); };
  auto const targets = [](DevicePatch const& patch, int) { return (patch.n_target + targets_per_team - 1) / targets_per_team; };
  batch.blocks = pieces(first, last, components_, blocks);
  batch.rows = pieces(first, last, components_, DeviceRows<Real, false>::count);
  batch.y_lines = pieces(first, last, components_, DeviceColumns<Real, 1, false>::count);
  batch.z_lines = pieces(first, last, components_, DeviceColumns<Real, 2, false>::count);
  batch.modes = pieces(first, last, components_, DeviceSymbol<Real, StokesletSymbol>::count);
  batch.z_lines_back = pieces(first, last, 3, DeviceColumns<Real, 2, true>::count);
  batch.y_lines_back = pieces(first, last, 3, DeviceColumns<Real, 1, true>::count);
  batch.rows_back = pieces(first, last, 3, DeviceRows<Real, true>::count);
  batch.targets = pieces(first, last, 3, targets);
  batches_.push_back(std::move(batch));
}

template <class Real>
template <class Count>
DevicePieces DeviceFar<Real>::pieces(std::size_t first, std::size_t last, int components, Count const& count) const {
  std::vector<long> begin{0};
  for (std::size_t i = first; i < last; ++i) begin.push_back(begin.back() + count(host_patches_[i], components));
  DevicePieces pieces{static_cast<int>(first), static_cast<int>(last - first), begin.back(), {}};
  send(pieces.begin, begin, "pieces");
  return pieces;
}

template <class Real>
void DeviceFar<Real>::put_strengths(DeviceArray<double> const& strengths) const {
  auto const on_grid = tables_.strengths;
  auto const normals = normals_;
  bool const with_normals = components_ == 6;
  Kokkos::parallel_for("asterflow::Fast::put_strengths", DeviceRange(0, n_source_),
                       KOKKOS_LAMBDA(long i) {
                         double const *const q = &strengths(3 * i), *const n = with_normals ? &normals(3 * i) : nullptr;
                         if (!with_normals) {
                           for (int c = 0; c < 3; ++c) on_grid(3 * i + c) = static_cast<Real>(q[c]);
                           return;
                         }
                         for (int c = 0; c < 3; ++c) {
                           int const a = c == 2 ? 1 : 0, b = c == 0 ? 1 : 2;  // xy xz yz
                           on_grid(6 * i + c) = static_cast<Real>(q[c] * n[c]);
                           on_grid(6 * i + 3 + c) = static_cast<Real>(0.5 * (q[a] * n[b] + q[b] * n[a]));
                         }
                       });
}

template <class Real>
void DeviceFar<Real>::add(DeviceArray<double> const& strengths, DeviceArray<double> const& velocity,
                          DeviceArray<double> const& slopes) {
  put_strengths(strengths);
  for (Batch const& batch : batches_) run(batch, velocity, slopes);
}

template <class Real>
void DeviceFar<Real>::run(Batch const& batch, DeviceArray<double> const& velocity, DeviceArray<double> const& slopes) const {
  auto const spread = [&](auto const& functor) {
    launch_teams<Real>("asterflow::Fast::spread", batch.blocks, threads, 1, 0, functor.scratch, functor);
  };
  if (components_ == 3)
    spread(DeviceSpread<Real, 3>{tables_, batch.blocks});
  else
    spread(DeviceSpread<Real, 6>{tables_, batch.blocks});
  auto const sweep = [&](DevicePieces const& pieces, int axis, auto functor) {
    int longest = 0;
    for (int i = pieces.first; i < pieces.first + pieces.n; ++i) longest = std::max(longest, host_patches_[i].nodes[axis]);
    long const numbers = DeviceLines<Real>::numbers(longest);
    functor.level = scratch_level(numbers * static_cast<long>(sizeof(Real)));
    launch_teams<Real>("asterflow::Fast::sweep", pieces, threads, 1, functor.level, numbers, functor);
  };
  sweep(batch.rows, 0, DeviceRows<Real, false>{tables_, batch.rows, 0});
  sweep(batch.y_lines, 1, DeviceColumns<Real, 1, false>{tables_, batch.y_lines, 0});
  sweep(batch.z_lines, 2, DeviceColumns<Real, 2, false>{tables_, batch.z_lines, 0});
  auto const multiply = [&](auto symbol) {
    Kokkos::parallel_for("asterflow::Fast::symbol", DeviceRange(0, batch.modes.total),
                         DeviceSymbol<Real, decltype(symbol)>{tables_, batch.modes});
  };
  switch (kernel_) {
    case FastKernel::stokeslet: multiply(StokesletSymbol()); break;
    case FastKernel::rotlet: multiply(RotletSymbol()); break;
    case FastKernel::stresslet: multiply(StressletSymbol()); break;
    case FastKernel::stokeslet_pressure: multiply(StokesletPressureSymbol()); break;
    case FastKernel::stresslet_pressure: multiply(StressletPressureSymbol()); break;
  }
  sweep(batch.z_lines_back, 2, DeviceColumns<Real, 2, true>{tables_, batch.z_lines_back, 0});
  sweep(batch.y_lines_back, 1, DeviceColumns<Real, 1, true>{tables_, batch.y_lines_back, 0});
  sweep(batch.rows_back, 0, DeviceRows<Real, true>{tables_, batch.rows_back, 0});
  DeviceInterpolation<Real> const interpolation{tables_, batch.targets, velocity, slopes};
  launch_teams<Real>("asterflow::Fast::interpolate", batch.targets, default_space_is_host ? 1 : 8, lanes, 0, interpolation.scratch,
                     interpolation);
}

template <class Real>
std::size_t DeviceFar<Real>::memory() const {
  std::size_t const reals = tables_.symbols.size() + tables_.twiddles.size() + tables_.strengths.size() + tables_.grid.size() +
                            tables_.spectrum.size();
  return patches_.memory() + sizeof(Real) * reals + 4 * (tables_.sources.size() + tables_.targets.size()) +
         8 * (tables_.first_sources.size() + tables_.source_points.size() + tables_.target_points.size() + normals_.size());
}

template class DeviceFar<float>;
template class DeviceFar<double>;

}  // namespace asterflow
