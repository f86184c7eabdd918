#include "backends/fast_grid.hpp"

#include "backends/fast_pack.hpp"
#include "backends/fast_window.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

// n numbers as vectors of the widest size that divides them.
template <class Real, int n>
struct Row {
  static constexpr int bytes = n * static_cast<int>(sizeof(Real));
  static constexpr int vector_bytes = bytes % pack_bytes == 0 ? pack_bytes : bytes % 32 == 0 && pack_bytes >= 32 ? 32 : 16;
  static constexpr int n_vector = bytes / vector_bytes;
  static constexpr int n_lane = n / n_vector;
  typedef Real V __attribute__((vector_size(vector_bytes)));
  typedef Real Unaligned __attribute__((vector_size(vector_bytes), aligned(sizeof(Real)), may_alias));
  V v[n_vector];

  static Row from(Real const* p) {
    Row row;
    for (int i = 0; i < n_vector; ++i) row.v[i] = reinterpret_cast<Unaligned const*>(p)[i];
    return row;
  }
  void to(Real* p) const {
    for (int i = 0; i < n_vector; ++i) reinterpret_cast<Unaligned*>(p)[i] = v[i];
  }
  static Row zero() {
    Row row;
    for (V& part : row.v) part = V{};
    return row;
  }
  // this + a * s
  void add_product(Row const& a, Real s) {
    for (int i = 0; i < n_vector; ++i) v[i] += a.v[i] * s;
  }
  Row scaled(Real s) const {
    Row row;
    for (int i = 0; i < n_vector; ++i) row.v[i] = v[i] * s;
    return row;
  }
  Real dot(Row const& a) const {
    V sum = v[0] * a.v[0];
    for (int i = 1; i < n_vector; ++i) sum += v[i] * a.v[i];
    Real total = 0;
    for (int i = 0; i < n_lane; ++i) total += sum[i];
    return total;
  }
};

int wrapped(int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; }

// Whether nodes first ... first + width - 1, continued periodically, meet the range.
bool overlaps(int first, int width, Range range, int n) {
  return (first < range.end && first + width > range.begin) || first + width - n > range.begin;
}

}  // namespace

template <class Real>
GridWindow<Real>::GridWindow(int width, double shape)
    : width_(width), padded_(width <= 8 ? 8 : width <= 12 ? 12 : 16), degree_(width + 3), shape_(shape) {
  KaiserBessel const window(shape);
  int const n = degree_ + 1;
  coefficients_.assign(static_cast<std::size_t>(n) * padded_, Real(0));
  for (int j = 0; j < width; ++j) {
    // Chebyshev interpolation in z = 2 s - 1 over the interval d = j - width / 2 + s, then monomials.
    std::vector<double> series(n, 0.0), before(n, 0.0), now(n, 0.0), next(n, 0.0), sum(n, 0.0);
    for (int k = 0; k < n; ++k)
      for (int i = 0; i < n; ++i) {
        double const z = std::cos(M_PI * (i + 0.5) / n);
        double const x = (j - 0.5 * width + 0.5 * (z + 1.0)) * 2.0 / width;
        series[k] += (k == 0 ? 1.0 : 2.0) / n * window.value(x) * std::cos(M_PI * k * (i + 0.5) / n);
      }
    now[0] = 1.0;
    for (int k = 0; k < n; ++k) {
      for (int i = 0; i < n; ++i) {
        sum[i] += series[k] * now[i];
        next[i] = (k == 0 ? 1.0 : 2.0) * (i > 0 ? now[i - 1] : 0.0) - (k == 0 ? 0.0 : before[i]);
      }
      before = now;
      now = next;
    }
    for (int i = 0; i < n; ++i) coefficients_[static_cast<std::size_t>(i) * padded_ + j] = static_cast<Real>(sum[i]);
  }
}

template <class Real>
double GridWindow<Real>::transform(double theta) const {
  return 0.5 * width_ * KaiserBessel(shape_).spectrum(0.5 * width_ * theta);
}

template <class Real>
long GridWindow<Real>::row(Patch<Real> const& patch) const {
  constexpr int n = lanes<Real>;
  return (patch.nodes[0] + padded_ + n - 1) / n * n;
}

template <class Real>
int GridWindow<Real>::first_node(double xi) const {
  return static_cast<int>(std::floor(xi - 0.5 * width_)) + 1;
}

template <class Real>
TiledPoints GridWindow<Real>::tile(Patch<Real> const& patch, PointArray const& points,
                                   std::vector<Range> const& ranges) const {
  int const n_tile = patch.tiles_y * patch.tiles_z;
  TiledPoints tiled;
  tiled.tile_begin.assign(n_tile + 1, 0);
  long n = 0;
  for (Range const& range : ranges) n += range.size();
  double const to_nodes = 1.0 / patch.spacing;
  std::vector<int> tiles;
  tiles.reserve(n);
  for (Range const& range : ranges)
    for (long i = range.begin; i < range.end; ++i) {
      Vec3d const xi = to_nodes * (points[i] - patch.origin);
      int const y = wrapped(first_node(xi.y), patch.nodes[1]), z = wrapped(first_node(xi.z), patch.nodes[2]);
      tiles.push_back(patch.tile_of(z, 2) * patch.tiles_y + patch.tile_of(y, 1));
      ++tiled.tile_begin[tiles.back() + 1];
    }
  for (int i = 0; i < n_tile; ++i) tiled.tile_begin[i + 1] += tiled.tile_begin[i];
  std::vector<long> next(tiled.tile_begin.begin(), tiled.tile_begin.end() - 1);
  tiled.index.resize(n);
  long k = 0;
  for (Range const& range : ranges)
    for (long i = range.begin; i < range.end; ++i, ++k) tiled.index[next[tiles[k]]++] = static_cast<std::uint32_t>(i);
  return tiled;
}

// The three rows of weights of one point; one loop, so that their chains of operations overlap.
template <class Real>
template <int padded>
void GridWindow<Real>::weights(Vec3d const& xi, int const (&first)[3], void* rows) const {
  using R = Row<Real, padded>;
  R* const sum = static_cast<R*>(rows);
  Real z[3];
  for (int d = 0; d < 3; ++d) z[d] = static_cast<Real>(2.0 * (first[d] - (xi[d] - 0.5 * width_)) - 1.0);
  Real const* c = coefficients_.data() + static_cast<std::size_t>(degree_) * padded;
  R x = R::from(c), y = x, w = x;
  for (int k = degree_ - 1; k >= 0; --k) {
    c -= padded;
    R const next = R::from(c);
    R nx = next, ny = next, nw = next;
    nx.add_product(x, z[0]);
    ny.add_product(y, z[1]);
    nw.add_product(w, z[2]);
    x = nx, y = ny, w = nw;
  }
  sum[0] = x, sum[1] = y, sum[2] = w;
}

template <class Real>
template <int padded, int components>
void GridWindow<Real>::spread_rows(Patch<Real> const& patch, long i_tile, PointArray const& points,
                                   Real const* strengths, Real* grid) const {
  using R = Row<Real, padded>;
  int const ty = static_cast<int>(i_tile % patch.tiles_y), tz = static_cast<int>(i_tile / patch.tiles_y);
  Range const ys = patch.tile_nodes(ty, 1), zs = patch.tile_nodes(tz, 2);
  long const row_length = row(patch), stride_y = components * row_length, stride_z = patch.nodes[1] * stride_y;
  double const to_nodes = 1.0 / patch.spacing;
  for (long z = zs.begin; z < zs.end; ++z)
    std::fill_n(grid + z * stride_z + ys.begin * stride_y, ys.size() * stride_y, Real(0));
  for (int dz = 0; dz < std::min(2, patch.tiles_z); ++dz)
    for (int dy = 0; dy < std::min(2, patch.tiles_y); ++dy) {
      int const from = wrapped(tz - dz, patch.tiles_z) * patch.tiles_y + wrapped(ty - dy, patch.tiles_y);
      for (long k = patch.sources.tile_begin[from]; k < patch.sources.tile_begin[from + 1]; ++k) {
        std::uint32_t const i = patch.sources.index[k];
        Vec3d const xi = to_nodes * (points[i] - patch.origin);
        int const first[3] = {first_node(xi.x), first_node(xi.y), first_node(xi.z)};
        int const y0 = wrapped(first[1], patch.nodes[1]), z0 = wrapped(first[2], patch.nodes[2]);
        if (!overlaps(y0, width_, ys, patch.nodes[1]) || !overlaps(z0, width_, zs, patch.nodes[2])) continue;
        R w[3];
        weights<padded>(xi, first, w);
        Real wy[padded], wz[padded];
        w[1].to(wy);
        w[2].to(wz);
        R const wx = w[0];
        int const x0 = wrapped(first[0], patch.nodes[0]);
        long offset_y[padded];
        Real weight_y[padded];
        int n_y = 0;
        for (int j = 0; j < width_; ++j) {
          int const y = wrapped(y0 + j, patch.nodes[1]);
          if (y < ys.begin || y >= ys.end) continue;
          offset_y[n_y] = y * stride_y;
          weight_y[n_y++] = wy[j];
        }
        Real const* f = strengths + static_cast<std::size_t>(i) * components;
        for (int j = 0; j < width_; ++j) {
          int const z = wrapped(z0 + j, patch.nodes[2]);
          if (z < zs.begin || z >= zs.end) continue;
          R load_x[components];
          for (int c = 0; c < components; ++c) load_x[c] = wx.scaled(wz[j] * f[c]);
          Real* const plane = grid + z * stride_z + x0;
          for (int m = 0; m < n_y; ++m) {
            Real* p = plane + offset_y[m];
            for (int c = 0; c < components; ++c, p += row_length) {
              R sum = R::from(p);
              sum.add_product(load_x[c], weight_y[m]);
              sum.to(p);
            }
          }
        }
      }
    }
}

template <class Real>
template <int components>
void GridWindow<Real>::spread_components(Patch<Real> const& patch, long i_tile, PointArray const& points,
                                         Real const* strengths, Real* grid) const {
  if (padded_ == 8) return spread_rows<8, components>(patch, i_tile, points, strengths, grid);
  if (padded_ == 12) return spread_rows<12, components>(patch, i_tile, points, strengths, grid);
  spread_rows<16, components>(patch, i_tile, points, strengths, grid);
}

template <class Real>
void GridWindow<Real>::spread(Patch<Real> const& patch, long i_tile, PointArray const& points, Real const* strengths,
                              int components, Real* grid) const {
  if (components == 3) return spread_components<3>(patch, i_tile, points, strengths, grid);
  spread_components<6>(patch, i_tile, points, strengths, grid);
}

template <class Real>
template <int padded>
void GridWindow<Real>::interpolate_rows(Patch<Real> const& patch, long i_tile, PointArray const& points,
                                        Real const* grid, int components, Vec3d* velocity) const {
  using R = Row<Real, padded>;
  long const row_length = row(patch), stride_y = components * row_length, stride_z = patch.nodes[1] * stride_y;
  double const to_nodes = 1.0 / patch.spacing;
  for (long k = patch.targets.tile_begin[i_tile]; k < patch.targets.tile_begin[i_tile + 1]; ++k) {
    std::uint32_t const i = patch.targets.index[k];
    Vec3d const xi = to_nodes * (points[i] - patch.origin);
    int const first[3] = {first_node(xi.x), first_node(xi.y), first_node(xi.z)};
    R w[3];
    weights<padded>(xi, first, w);
    R const wx = w[0];
    Real wy[padded], wz[padded];
    w[1].to(wy);
    w[2].to(wz);
    R sum[3] = {R::zero(), R::zero(), R::zero()};
    Real const* const corner = grid + first[2] * stride_z + first[1] * stride_y + first[0];
    for (int jz = 0; jz < width_; ++jz) {
      R plane[3] = {R::zero(), R::zero(), R::zero()};
      for (int jy = 0; jy < width_; ++jy)
        for (int c = 0; c < 3; ++c)
          plane[c].add_product(R::from(corner + jz * stride_z + jy * stride_y + c * row_length), wy[jy]);
      for (int c = 0; c < 3; ++c) sum[c].add_product(plane[c], wz[jz]);
    }
    Vec3d u{};
    for (int c = 0; c < 3; ++c) u[c] = sum[c].dot(wx);
    velocity[i] += patch.scale * u;
  }
}

template <class Real>
void GridWindow<Real>::interpolate(Patch<Real> const& patch, long i_tile, PointArray const& points, Real const* grid,
                                   int components, Vec3d* velocity) const {
  if (padded_ == 8) return interpolate_rows<8>(patch, i_tile, points, grid, components, velocity);
  if (padded_ == 12) return interpolate_rows<12>(patch, i_tile, points, grid, components, velocity);
  interpolate_rows<16>(patch, i_tile, points, grid, components, velocity);
}

template class GridWindow<float>;
template class GridWindow<double>;

}  // namespace asterflow
