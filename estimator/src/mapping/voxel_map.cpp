// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/voxel_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"

namespace tumble {

using mapping::voxel_cube_of;

namespace {

// Map points are stored in blocks (chunks). Unused elements of a chunk have coordinates beyond any search radius.
constexpr float kFar = 1e18f;
constexpr int kReachMax = 8;  // maximum number of cells that a search covers to each side

inline void keep_nearest(float distance2, std::uint32_t index, int k, NearestNeighbours& best) {
  int place = best.count < k ? best.count++ : k - 1;
  while (place > 0 && best.distance2_m2[place - 1] > distance2) {
    best.distance2_m2[place] = best.distance2_m2[place - 1];
    best.index[place] = best.index[place - 1];
    --place;
  }
  best.distance2_m2[place] = distance2;
  best.index[place] = index;
}

/// `fraction` is the position of the query point within its cell, divided by the edge length of the cell.
void squared_axis_distances(float fraction, float voxel_m, int reach, float* distance2) {
  for (int d = -reach; d <= reach; ++d) {
    const float cells = d > 0 ? static_cast<float>(d) - fraction : d < 0 ? fraction - static_cast<float>(d + 1) : 0.0f;
    distance2[d + reach] = cells * cells * voxel_m * voxel_m;
  }
}

// Compilers do not vectorise the comparison of squared distances, so values_within_limit() uses explicit SIMD vectors.
using Floats [[gnu::vector_size(16)]] = float;
using Ints [[gnu::vector_size(16)]] = std::int32_t;

/// Returns a bit mask of the elements of `values` that are at most `limit`. The function contains no branches.
inline std::uint32_t values_within_limit(float limit, const Floats (&values)[4]) {
  constexpr Ints kFirst = {1, 2, 4, 8};
  const Floats limits = {limit, limit, limit, limit};
  const Ints bits = ((values[0] <= limits) & kFirst) | ((values[1] <= limits) & (kFirst << 4)) |
                    ((values[2] <= limits) & (kFirst << 8)) | ((values[3] <= limits) & (kFirst << 12));
  return static_cast<std::uint32_t>(bits[0] | bits[1] | bits[2] | bits[3]);
}

/// The sequence 0, 1, -1, 2, -2 lets the neighbour search visit near cells first, so that the search radius decreases
/// early.
inline int alternating_offset(int i) {
  return (i & 1) ? (i + 1) / 2 : -i / 2;
}

}  // namespace

VoxelMap::VoxelMap(const Params& params) : params_(params) {
  require_valid_fields(params);
  require_in_interval("spacing_m", params.spacing_m, 0.0, params.voxel_m);
  cells_per_m_ = static_cast<float>(1.0 / params.voxel_m);
  cubes_per_m_ = params.spacing_m > 0.0 ? static_cast<float>(1.0 / params.spacing_m) : cells_per_m_;
}

inline std::size_t VoxelMap::VoxelGroup::row_index_of(int y, int z) {
  return static_cast<std::size_t>((y & kMask) | ((z & kMask) << kBits));
}

inline std::size_t VoxelMap::VoxelGroup::cell_index_of(const Eigen::Vector3i& cell) {
  return static_cast<std::size_t>(cell.x() & kMask) | (row_index_of(cell.y(), cell.z()) << kBits);
}

inline Eigen::Vector3i VoxelMap::VoxelGroup::of(const Eigen::Vector3i& cell) {
  return {cell.x() >> kBits, cell.y() >> kBits, cell.z() >> kBits};
}

/// NeighbourVoxelRows looks up each group of 8 x 8 x 8 cells in the hash table at most once per neighbour search.
class VoxelMap::NeighbourVoxelRows {
 public:
  NeighbourVoxelRows(const VoxelMap& map, const Eigen::Vector3i& cell, int reach)
      : map_(map), first_voxel_x_(cell.x() - reach) {
    low_ = VoxelGroup::of(cell.array() - reach);
    row_length_ = VoxelGroup::of(cell.array() + reach).x() - low_.x() + 1;
    neighbour_groups_.fill(kGroupNotSearched);
  }

  /// Returns one bit per cell of a row, which is set if the cell contains points. The lowest bit belongs to the cell
  /// with the smallest x.
  std::uint32_t occupied(int y, int z) {
    const Eigen::Vector3i away = VoxelGroup::of({first_voxel_x_, y, z}) - low_;
    std::uint32_t bits = 0;
    for (int x = 0; x < row_length_; ++x) {
      const std::uint32_t group = voxel_group_of({x, away.y(), away.z()});
      if (group == SpatialHash::kAbsentEntry) continue;
      bits |= std::uint32_t{map_.voxel_groups_[group].rows[VoxelGroup::row_index_of(y, z)]} << (x << VoxelGroup::kBits);
    }
    return bits >> (first_voxel_x_ & VoxelGroup::kMask);
  }

  std::uint32_t first_chunk(const Eigen::Vector3i& cell) {
    return map_.voxel_groups_[voxel_group_of(VoxelGroup::of(cell) - low_)].first[VoxelGroup::cell_index_of(cell)];
  }

 private:
  static constexpr int kGroupsPerSide =
      (2 * kReachMax + VoxelGroup::kMask) / (VoxelGroup::kMask + 1) + 1;  // maximum number of groups along an axis
  static constexpr std::uint32_t kGroupNotSearched = SpatialHash::kAbsentEntry - 1;

  std::uint32_t voxel_group_of(const Eigen::Vector3i& away) {
    std::uint32_t& group =
        neighbour_groups_[static_cast<std::size_t>((away.z() * kGroupsPerSide + away.y()) * kGroupsPerSide + away.x())];
    if (group == kGroupNotSearched) group = map_.voxel_group_index_.find(SpatialHash::key(low_ + away));
    return group;
  }

  const VoxelMap& map_;
  int first_voxel_x_, row_length_;
  Eigen::Vector3i low_;  // group of the lowest cell
  std::array<std::uint32_t, kGroupsPerSide * kGroupsPerSide * kGroupsPerSide> neighbour_groups_;
};

std::uint32_t& VoxelMap::first_chunk_of(const Eigen::Vector3i& cell) {
  const std::uint32_t group = voxel_group_index_.insert(SpatialHash::key(VoxelGroup::of(cell)),
                                                        static_cast<std::uint32_t>(voxel_groups_.size()));
  if (group == voxel_groups_.size()) voxel_groups_.emplace_back().first.fill(kNone);
  voxel_groups_[group].rows[VoxelGroup::row_index_of(cell.y(), cell.z())] |=
      static_cast<std::uint8_t>(1 << (cell.x() & VoxelGroup::kMask));
  return voxel_groups_[group].first[VoxelGroup::cell_index_of(cell)];
}

std::uint32_t VoxelMap::new_chunk(std::uint32_t& first) {
  PointChunk chunk;
  chunk.x.fill(kFar);
  chunk.y.fill(kFar);
  chunk.z.fill(kFar);
  chunk.next = first;
  first = static_cast<std::uint32_t>(point_chunks_.size());
  point_chunks_.push_back(chunk);
  sigma_m_.resize(sigma_m_.size() + kPointsPerChunk, -1.0f);
  sweep_.resize(sweep_.size() + kPointsPerChunk, 0);
  line_.resize(line_.size() + kPointsPerChunk, kUnknownScanLine);
  seen_through_counts_.resize(seen_through_counts_.size() + kPointsPerChunk, 0);
  free_slots_ += kPointsPerChunk;
  return first;
}

/// A position must be within the range of the map's integer coordinates, with a margin for the cells around the
/// position that a search visits.
bool VoxelMap::has_room_for(const Eigen::Vector3f& position) const {
  return (position * cubes_per_m_).cwiseAbs().maxCoeff() < static_cast<float>(SpatialHash::kCoordinateLimit - 2);
}

bool VoxelMap::is_occupied(const Eigen::Vector3f& position) const {
  if (!has_room_for(position)) return true;
  return params_.spacing_m > 0.0 &&
         occupied_cubes_.find(SpatialHash::key(voxel_cube_of(position, cubes_per_m_))) != SpatialHash::kAbsentEntry;
}

std::uint32_t VoxelMap::add(const Eigen::Vector3f& position, float sigma_m, std::uint32_t sweep, std::uint32_t line) {
  if (!has_room_for(position)) return kNoPoint;
  if (params_.spacing_m > 0.0 && !occupied_cubes_.add(SpatialHash::key(voxel_cube_of(position, cubes_per_m_))))
    return kNoPoint;
  return store_point(position, sigma_m, sweep, line);
}

std::uint32_t VoxelMap::store_point(const Eigen::Vector3f& position, float sigma_m, std::uint32_t sweep,
                                    std::uint32_t line) {
  // The list of chunks (blocks of points) of a cell starts with the newest chunk, and only the newest chunk has unused
  // elements.
  std::uint32_t& first = first_chunk_of(voxel_cube_of(position, cells_per_m_));
  if (first == kNone || point_chunks_[first].count == kPointsPerChunk) new_chunk(first);
  PointChunk& chunk = point_chunks_[first];
  const std::uint32_t place = chunk.count++;
  chunk.x[place] = position.x();
  chunk.y[place] = position.y();
  chunk.z[place] = position.z();
  sigma_m_[first * kPointsPerChunk + place] = std::max(sigma_m, 0.0f);
  sweep_[first * kPointsPerChunk + place] = sweep;
  line_[first * kPointsPerChunk + place] = line;
  --free_slots_;
  return first * kPointsPerChunk + place;
}

bool VoxelMap::move(std::uint32_t index, const Eigen::Vector3f& position) {
  if (!position.allFinite() ||
      voxel_cube_of(position, cells_per_m_) != voxel_cube_of(position_W_m(index), cells_per_m_)) {
    return false;
  }
  PointChunk& chunk = point_chunks_[index / kPointsPerChunk];
  const std::uint32_t place = index % kPointsPerChunk;
  chunk.x[place] = position.x();
  chunk.y[place] = position.y();
  chunk.z[place] = position.z();
  return true;
}

void VoxelMap::count_observation(std::uint32_t index, bool through) {
  std::uint8_t& count = seen_through_counts_[index];
  if (through ? count < std::numeric_limits<std::uint8_t>::max() : count > 0) count += through ? 1 : -1;
}

Eigen::Vector3f VoxelMap::position_W_m(std::uint32_t index) const {
  const PointChunk& chunk = point_chunks_[index / kPointsPerChunk];
  const std::uint32_t place = index % kPointsPerChunk;
  return {chunk.x[place], chunk.y[place], chunk.z[place]};
}

std::vector<std::uint32_t> VoxelMap::remove_points_beyond(const Eigen::Vector3f& centre, float radius_m) {
  const auto stays = [&](std::uint32_t index) {
    return exists(index) && (position_W_m(index) - centre).squaredNorm() <= radius_m * radius_m;
  };
  std::vector<std::uint32_t> kept;
  for (std::uint32_t index = 0; index < index_end(); ++index) {
    if (stays(index)) kept.push_back(sweep_[index]);
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());

  VoxelMap near(params_);
  for (std::uint32_t index = 0; index < index_end(); ++index) {
    if (!stays(index)) continue;
    const auto number = std::lower_bound(kept.begin(), kept.end(), sweep_[index]) - kept.begin();
    const std::uint32_t now =
        near.add(position_W_m(index), sigma_m_[index], static_cast<std::uint32_t>(number), line_[index]);
    if (now != kNoPoint) near.seen_through_counts_[now] = seen_through_counts_[index];
  }
  *this = std::move(near);
  return kept;
}

void VoxelMap::remove_sweeps_from(std::uint32_t first_sweep) {
  VoxelMap kept(params_);
  for (std::uint32_t index = 0; index < index_end(); ++index) {
    if (!exists(index) || sweep_[index] >= first_sweep) continue;
    const Eigen::Vector3f position = position_W_m(index);
    // Smoothing may have moved two points into one cube with the edge length `spacing_m`. If a cube contains two
    // points, the map keeps both points.
    if (params_.spacing_m > 0.0) kept.occupied_cubes_.add(SpatialHash::key(voxel_cube_of(position, cubes_per_m_)));
    const std::uint32_t now = kept.store_point(position, sigma_m_[index], sweep_[index], line_[index]);
    kept.seen_through_counts_[now] = seen_through_counts_[index];
  }
  *this = std::move(kept);
}

std::size_t VoxelMap::bytes() const {
  return voxel_group_index_.bytes() + occupied_cubes_.bytes() + voxel_groups_.capacity() * sizeof(VoxelGroup) +
         point_chunks_.capacity() * sizeof(PointChunk) + sigma_m_.capacity() * sizeof(float) +
         (sweep_.capacity() + line_.capacity()) * sizeof(std::uint32_t) + seen_through_counts_.capacity();
}

void VoxelMap::search_neighbours(std::uint32_t first, const Eigen::Vector3f& query, int k, float& worst_distance2_m2,
                                 NearestNeighbours& found) const {
  for (std::uint32_t c = first; c != kNone; c = point_chunks_[c].next) {
    const PointChunk& chunk = point_chunks_[c];
    alignas(16) float distance2[kPointsPerChunk];
    for (int i = 0; i < kPointsPerChunk; ++i) {
      const float ex = chunk.x[i] - query.x(), ey = chunk.y[i] - query.y(), ez = chunk.z[i] - query.z();
      distance2[i] = ex * ex + ey * ey + ez * ez;
    }
    Floats four[kPointsPerChunk / 4];
    std::memcpy(four, distance2, sizeof(four));
    for (std::uint32_t near = values_within_limit(worst_distance2_m2, four); near != 0; near &= near - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
      if (distance2[i] > worst_distance2_m2 || (found.count == k && distance2[i] == worst_distance2_m2)) continue;
      keep_nearest(distance2[i], c * kPointsPerChunk + i, k, found);
      if (found.count == k) worst_distance2_m2 = found.distance2_m2[k - 1];
    }
  }
}

void VoxelMap::nearest(const Eigen::Vector3f& query, int k, float radius_m, NearestNeighbours& found) const {
  found.count = 0;
  const float voxel_m = static_cast<float>(params_.voxel_m);
  const float span = query.cwiseAbs().maxCoeff() * cells_per_m_;
  if (k <= 0 || !(span < static_cast<float>(SpatialHash::kCoordinateLimit - kReachMax - 2))) return;
  k = std::min(k, NearestNeighbours::kMaxNeighbours);

  const Eigen::Vector3i cell = voxel_cube_of(query, cells_per_m_);
  const Eigen::Vector3f fraction = query * cells_per_m_ - cell.cast<float>();
  const int reach = std::min(kReachMax, static_cast<int>(std::ceil(radius_m * cells_per_m_)));
  float slab[3][2 * kReachMax + 1];
  for (int axis = 0; axis < 3; ++axis) squared_axis_distances(fraction[axis], voxel_m, reach, slab[axis]);

  float worst_distance2_m2 = std::min(radius_m, static_cast<float>(reach) * voxel_m);
  worst_distance2_m2 *= worst_distance2_m2;
  NeighbourVoxelRows rows(*this, cell, reach);
  const int steps = 2 * reach + 1;
  for (int iz = 0; iz < steps; ++iz) {
    const int dz = alternating_offset(iz);
    const float to_z = slab[2][dz + reach];
    if (to_z > worst_distance2_m2) continue;
    for (int iy = 0; iy < steps; ++iy) {
      const int dy = alternating_offset(iy);
      const float to_yz = to_z + slab[1][dy + reach];
      if (to_yz > worst_distance2_m2) continue;
      const std::uint32_t occupied = rows.occupied(cell.y() + dy, cell.z() + dz);
      if (occupied == 0) continue;
      for (int ix = 0; ix < steps; ++ix) {
        const int dx = alternating_offset(ix);
        if (!(occupied >> (dx + reach) & 1) || to_yz + slab[0][dx + reach] > worst_distance2_m2) continue;
        search_neighbours(rows.first_chunk(cell + Eigen::Vector3i(dx, dy, dz)), query, k, worst_distance2_m2, found);
      }
    }
  }
}

}  // namespace tumble

namespace tumble::mapping {

namespace {

// cosine of 0.05 rad: if the lidar's spin axis has rotated less, a ring of the lidar measures the same scan line again
constexpr double kSameLineCosine = 0.9988;
constexpr int kRingBits = 16;
// The exported map excludes points through which beams of at least kSeenThrough sweeps passed. A single sweep is not
// sufficient to exclude a map point, because the nearest return in a direction may be wrong near the edge of a surface.
constexpr std::uint8_t kSeenThrough = 2;

}  // namespace

std::uint32_t ScanLines::line_number_offset(const Eigen::Vector3d& spin_axis_W, bool has_ring_numbers) {
  if (!has_ring_numbers) return VoxelMap::kUnknownScanLine;
  if (spin_axis_W.dot(axis_W_) < kSameLineCosine) {
    axis_W_ = spin_axis_W;
    ++attitude_;
  }
  return attitude_ << kRingBits;
}

std::vector<MapPoint> to_map_points(const VoxelMap& map, std::span<const Eigen::Vector3f> seen_from_W_m, int neighbours,
                                    double match_distance_m) {
  std::vector<MapPoint> out;
  out.reserve(map.size());
  NearestNeighbours found;
  for (std::uint32_t index = 0; index < map.index_end(); ++index) {
    if (!map.exists(index) || map.seen_through_count(index) >= kSeenThrough) continue;
    MapPoint& point = out.emplace_back();
    point.position_W_m = map.position_W_m(index);
    point.sigma_m = map.sigma_m(index);
    map.nearest(point.position_W_m, neighbours, static_cast<float>(match_distance_m), found);
    const PlaneFit plane = fit_plane(map, found, PlaneFitBounds{});
    if (plane.verdict != PlaneVerdict::plane) continue;
    const Eigen::Vector3f towards = seen_from_W_m[map.sweep(index)] - point.position_W_m;
    point.normal_W = plane.normal_W.dot(towards) < 0.0f ? Eigen::Vector3f(-plane.normal_W) : plane.normal_W;
  }
  return out;
}

}  // namespace tumble::mapping
