#pragma once
// Spreading of strengths onto the grids of patches, and interpolation from the grids of velocities, as kernels for any
// execution space. A team owns one block of nodes, which collects what the windows of nearby points leave in it:
// nobody else writes there, so no atomics are needed and sums have a fixed order.

#include "backends/fast_device_patch.hpp"

namespace asterflow {

inline constexpr int points_per_chunk = 32;  // whose weights are in scratch memory together
inline constexpr int targets_per_team = 16;
inline constexpr int max_width = 16;

template <class Real, int components>
struct DeviceSpread {
  DeviceTables<Real> tables;
  DevicePieces blocks;
  static constexpr int block_nodes = block_edge * block_edge * block_edge;
  static constexpr int numbers_per_point = 3 * block_edge + components;
  static constexpr int scratch = points_per_chunk * numbers_per_point;  // numbers

  KOKKOS_FUNCTION void operator()(DeviceTeam const& team) const {
    long i_block = team.league_rank();
    DevicePatch const& patch = tables.patches(blocks.patch_of(i_block));
    int const block[3] = {static_cast<int>(i_block % patch.blocks[0]), static_cast<int>(i_block / patch.blocks[0] % patch.blocks[1]),
                          static_cast<int>(i_block / (patch.blocks[0] * patch.blocks[1]))};
    DeviceScratch<Real> const numbers(team.team_scratch(0), scratch);
    clear(team, patch, block);
    int back[3];
    for (int d = 0; d < 3; ++d) back[d] = reach(patch, d, block[d]);
    for (int dz = 0; dz <= back[2]; ++dz)
      for (int dy = 0; dy <= back[1]; ++dy)
        for (int dx = 0; dx <= back[0]; ++dx) {
          long const from = (static_cast<long>(wrapped_node(block[2] - dz, patch.blocks[2])) * patch.blocks[1] +
                             wrapped_node(block[1] - dy, patch.blocks[1])) * patch.blocks[0] +
                            wrapped_node(block[0] - dx, patch.blocks[0]);
          long const begin = tables.first_sources(patch.source_begin + from), end = tables.first_sources(patch.source_begin + from + 1);
          for (long chunk = begin; chunk < end; chunk += points_per_chunk) {
            int const n = static_cast<int>(end - chunk < points_per_chunk ? end - chunk : points_per_chunk);
            add_chunk(team, patch, block, chunk, n, numbers);
          }
        }
  }

  // How many blocks before this one have windows that end in it.
  KOKKOS_FUNCTION int reach(DevicePatch const& patch, int d, int block) const {
    int back = 0, covered = 0;
    while (covered < tables.window.width - 1 && back < patch.blocks[d] - 1) {
      ++back;
      int const other = wrapped_node(block - back, patch.blocks[d]), left = patch.nodes[d] - other * block_edge;
      covered += left < block_edge ? left : block_edge;
    }
    return back;
  }

  KOKKOS_FUNCTION Real* node(DevicePatch const& patch, int const (&block)[3], int column, int z, int c) const {
    long const x = block[0] * block_edge + column % block_edge, y = block[1] * block_edge + column / block_edge;
    long const plane = block[2] * block_edge + z;
    if (x >= patch.nodes[0] || y >= patch.nodes[1] || plane >= patch.nodes[2]) return nullptr;
    return &tables.grid(patch.grid + c * patch.n_node() + (plane * patch.nodes[1] + y) * patch.nodes[0] + x);
  }

  KOKKOS_FUNCTION void clear(DeviceTeam const& team, DevicePatch const& patch, int const (&block)[3]) const {
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, block_edge * block_edge), [&](int column) {
      for (int c = 0; c < components; ++c)
        for (int z = 0; z < block_edge; ++z)
          if (Real* const at = node(patch, block, column, z, c)) *at = Real(0);
    });
  }

  // Weights of the points at the nodes of this block: [point][3][block_edge], then strengths [point][components].
  KOKKOS_FUNCTION void add_chunk(DeviceTeam const& team, DevicePatch const& patch, int const (&block)[3], long chunk, int n,
                                 DeviceScratch<Real> const& numbers) const {
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, n * 3 * block_edge), [&](int k) {
      int const d = k / block_edge % 3, i = k % block_edge;
      long const source = tables.sources(chunk + k / (3 * block_edge));
      Real z;
      int const j = wrapped_node(block[d] * block_edge + i - patch.first_node(tables.source_points(3 * source + d), d, z), patch.nodes[d]);
      numbers(k) = j < tables.window.width ? tables.window.weight(j, z, false) : Real(0);
    });
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, n * components), [&](int k) {
      long const source = tables.sources(chunk + k / components);
      numbers(points_per_chunk * 3 * block_edge + k) = tables.strengths(source * components + k % components);
    });
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, block_edge * block_edge), [&](int column) {
      Real sum[components][block_edge] = {};
      for (int i = 0; i < n; ++i) {
        Real const* const w = &numbers(i * 3 * block_edge);
        Real const* const strength = &numbers(points_per_chunk * 3 * block_edge + i * components);
        Real const xy = w[column % block_edge] * w[block_edge + column / block_edge];
        if (xy == Real(0)) continue;
        for (int c = 0; c < components; ++c)
          for (int z = 0; z < block_edge; ++z) sum[c][z] += xy * strength[c] * w[2 * block_edge + z];
      }
      for (int c = 0; c < components; ++c)
        for (int z = 0; z < block_edge; ++z)
          if (Real* const at = node(patch, block, column, z, c)) *at += sum[c][z];
    });
  }
};

// Targets in groups of targets_per_team of one patch; the nodes along x of a window in vector lanes.
template <class Real>
struct DeviceInterpolation {
  DeviceTables<Real> tables;
  DevicePieces groups;
  DeviceArray<double> velocity, slopes;  // [n_target, 3], [n_target, 3, 3] or empty
  static constexpr int numbers_per_target = 2 * 3 * max_width;
  static constexpr int scratch = targets_per_team * numbers_per_target;  // numbers

  KOKKOS_FUNCTION void operator()(DeviceTeam const& team) const {
    long i_group = team.league_rank();
    DevicePatch const& patch = tables.patches(groups.patch_of(i_group));
    long const first = patch.target_begin + i_group * targets_per_team, left = patch.target_begin + patch.n_target - first;
    int const n = static_cast<int>(left < targets_per_team ? left : targets_per_team), width = tables.window.width;
    bool const with_slopes = slopes.extent(0) > 0;
    DeviceScratch<Real> const weights(team.team_scratch(0), scratch);
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, n * 3), [&](int k) {
      Real z;
      patch.first_node(tables.target_points(3L * tables.targets(first + k / 3) + k % 3), k % 3, z);
      for (int kind = 0; kind < (with_slopes ? 2 : 1); ++kind)
        Kokkos::parallel_for(Kokkos::ThreadVectorRange(team, width), [&](int j) {
          weights(((k / 3 * 2 + kind) * 3 + k % 3) * max_width + j) = tables.window.weight(j, z, kind == 1);
        });
    });
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, n), [&](int i) {
      long const target = tables.targets(first + i);
      for (int direction = 0; direction < (with_slopes ? 4 : 1); ++direction)
        for (int c = 0; c < 3; ++c) {
          Real const sum = weighted_sum(team, patch, target, c, direction, &weights(i * numbers_per_target));
          Kokkos::single(Kokkos::PerThread(team), [&]() {
            if (direction == 0)
              velocity(3 * target + c) += patch.scale * sum;
            else
              slopes(9 * target + 3 * c + direction - 1) += patch.slope_scale * sum;
          });
        }
    });
  }

  // Of component c under the window, or its slope in one direction 1 ... 3; weights [2][3][max_width].
  KOKKOS_FUNCTION Real weighted_sum(DeviceTeam const& team, DevicePatch const& patch, long target, int c, int direction,
                                    Real const* weights) const {
    int const width = tables.window.width;
    int first[3];
    Real const* w[3];
    for (int d = 0; d < 3; ++d) {
      Real z;
      first[d] = patch.first_node(tables.target_points(3 * target + d), d, z);
      w[d] = weights + ((direction == d + 1 ? 3 : 0) + d) * max_width;
    }
    long const component = patch.grid + c * patch.n_node();
    Real sum = 0;
    Kokkos::parallel_reduce(Kokkos::ThreadVectorRange(team, width), [&](int jx, Real& total) {
      long const x = component + wrapped_node(first[0] + jx, patch.nodes[0]);
      Real column = 0;
      for (int jz = 0; jz < width; ++jz) {
        long const plane = static_cast<long>(wrapped_node(first[2] + jz, patch.nodes[2])) * patch.nodes[1];
        Real row = 0;
        for (int jy = 0; jy < width; ++jy)
          row += w[1][jy] * tables.grid(x + (plane + wrapped_node(first[1] + jy, patch.nodes[1])) * patch.nodes[0]);
        column += w[2][jz] * row;
      }
      total += w[0][jx] * column;
    }, sum);
    return sum;
  }
};

}  // namespace asterflow
