// SPDX-License-Identifier: BSD-3-Clause
// voxel_map_state.cpp saves and loads a VoxelMap; loading rebuilds the search structure.
#include "../common/state_bytes.hpp"
#include "../common/state_layout.hpp"
#include "tumble/mapping/voxel_map.hpp"
#include "voxel_cube.hpp"

namespace tumble {

using mapping::cube_of;

void VoxelMap::save(StateWriter& out) const {
  out.length("map.chunks", chunks_.size());
  for (std::uint32_t c = 0; c < chunks_.size(); ++c) {
    const Chunk& chunk = chunks_[c];
    const auto count = static_cast<std::uint8_t>(chunk.count);
    out("map.chunk.count", count);
    for (std::uint32_t index = c * kPointsPerChunk; index < c * kPointsPerChunk + count; ++index) {
      const Eigen::Vector3f position_W_m = this->position_W_m(index);
      out("map.position_W_m", position_W_m);
      out("map.sigma_m", sigma_m_[index]);
      out("map.sweep", sweep_[index]);
      out("map.line", line_[index]);
      out("map.seen_through", seen_through_[index]);
    }
  }
  const std::vector<std::uint64_t> taken = occupied_cubes_.keys();
  out("map.taken", taken);
}

void VoxelMap::load(StateReader& in) {
  VoxelMap map(params_);
  const std::size_t chunks = in.length("map.chunks", 0);
  for (std::size_t c = 0; c < chunks && in.going(); ++c) map.load_chunk(in);
  std::vector<std::uint64_t> taken;
  in("map.taken", taken);
  for (std::size_t k = 0; k < taken.size() && in.going(); ++k) {
    in.require("map.taken", taken[k] >> 63 == 0 && (k == 0 || taken[k - 1] < taken[k]), double(taken[k]));
    map.occupied_cubes_.add(taken[k]);
  }
  if (in.going()) *this = std::move(map);
}

/// Loads the next chunk (block of map points). The chunks of a cell were saved in the order in which they were filled,
/// so only the last chunk of a cell has unused slots.
void VoxelMap::load_chunk(StateReader& in) {
  std::uint8_t count = 0;
  in("map.chunk.count", count, 1.0, kPointsPerChunk);
  Eigen::Vector3i cell = Eigen::Vector3i::Zero();
  std::uint32_t index = 0;
  for (int k = 0; k < count && in.going(); ++k, ++index) {
    Eigen::Vector3f position_W_m;
    float sigma_m = 0.0f;
    std::uint32_t sweep = 0, line = 0;
    std::uint8_t seen_through = 0;
    in("map.position_W_m", position_W_m);
    in("map.sigma_m", sigma_m, 0.0, std::numeric_limits<float>::max());
    in("map.sweep", sweep);
    in("map.line", line);
    in("map.seen_through", seen_through);
    if (!in.going()) return;
    in.require("map.position_W_m", has_room_for(position_W_m), position_W_m.cwiseAbs().maxCoeff(),
               (SpatialHash::kLimit - 2) / double(cubes_per_m_));
    if (!in.going()) return;
    const Eigen::Vector3i its_cell = cube_of(position_W_m, cells_per_m_);
    if (k == 0) {
      cell = its_cell;
      std::uint32_t& first = first_chunk_of(cell);
      in.require("map.chunk before", first == kNone || chunks_[first].count == kPointsPerChunk, 0.0, kPointsPerChunk);
      if (!in.going()) return;
      index = new_chunk(first) * kPointsPerChunk;
    }
    in.require("map.position_W_m", its_cell == cell, position_W_m.x());
    Chunk& chunk = chunks_[index / kPointsPerChunk];
    const std::uint32_t place = chunk.count++;
    chunk.x[place] = position_W_m.x();
    chunk.y[place] = position_W_m.y();
    chunk.z[place] = position_W_m.z();
    sigma_m_[index] = sigma_m;
    sweep_[index] = sweep;
    line_[index] = line;
    seen_through_[index] = seen_through;
    --free_slots_;
  }
}

void VoxelMap::describe(StateLayout& out) {
  const std::uint8_t count = 0, seen_through = 0;
  const Eigen::Vector3f position_W_m = Eigen::Vector3f::Zero();
  const float sigma_m = 0.0f;
  const std::uint32_t sweep = 0, line = 0;
  const std::vector<std::uint64_t> taken;
  out("map.chunk.count", count);
  out("map.position_W_m", position_W_m);
  out("map.sigma_m", sigma_m);
  out("map.sweep", sweep);
  out("map.line", line);
  out("map.seen_through", seen_through);
  out("map.taken", taken);
}

}  // namespace tumble
