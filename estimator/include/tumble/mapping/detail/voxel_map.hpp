// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Nearest points of a map, nearest first.
struct NearestNeighbours {
  static constexpr int kMaxNeighbours = 32;
  int count = 0;
  std::array<float, kMaxNeighbours> distance2_m2;
  std::array<std::uint32_t, kMaxNeighbours> index;
};

/// Stores map points in world axes, at most one per cube of edge `spacing_m`, and finds nearest neighbours. Coordinates
/// are single-precision floats, which limits the width of a map to a few kilometres.
class VoxelMap {
 public:
  static constexpr std::uint32_t kUnknownScanLine = 0xffffffffu;
  static constexpr std::uint32_t kNoPoint = 0xffffffffu;

  struct Params {
    double voxel_m = 0.5;    ///< edge of a cell; nearest-neighbour search is fastest at a few times spacing_m
    double spacing_m = 0.1;  ///< edge of a cube that keeps at most one point; 0 keeps all points

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.voxel_m,
            {"voxel_m", "m", 0.01, 100.0,
             "edge length of a cell; the search for neighbours is fastest at a few times the spacing of the points"});
      visit(p.spacing_m, {"spacing_m", "m", 0.0, 100.0,
                          "edge length of the cube that stores at most one point; 0: store all points"});
    }
  };

  explicit VoxelMap(const Params& params);

  /// Adds a point if the cube at its position is empty, and returns whether the point was added. `sigma_m` is the
  /// standard deviation of the point's position. `sweep` and `line` are numbers that sweep() and line() return. Points
  /// that are not finite or beyond 2^20 cells from the origin are rejected.
  bool insert(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep,
              std::uint32_t line = kUnknownScanLine) {
    return add(position_W_m, sigma_m, sweep, line) != kNoPoint;
  }

  /// Adds a point like insert(), and returns its index, or kNoPoint if the point was rejected.
  std::uint32_t add(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep, std::uint32_t line);
  /// Returns true if add() would reject a point at this position.
  bool is_occupied(const Eigen::Vector3f& position_W_m) const;

  /// Moves a point. Returns false and leaves the point unchanged if the new position is in another cell.
  bool move(std::uint32_t index, const Eigen::Vector3f& position_W_m);

  /// Counts a sweep whose beam passed through the position of a point (`through` is true) or hit the point again
  /// (`through` is false).
  void count_observation(std::uint32_t index, bool through);

  /// Finds the k <= NearestNeighbours::kMaxNeighbours nearest points within `radius_m`, without allocating memory. The
  /// cost grows with the number of cells within the distance of the k-th neighbour.
  void nearest(const Eigen::Vector3f& query_W_m, int k, float radius_m, NearestNeighbours& found) const;

  /// Deletes the points farther than `radius_m` from `centre_W_m`. The indices of points change, and sweeps with
  /// remaining points are renumbered in order. Returns the old numbers of these sweeps. Cost: O(number of points).
  std::vector<std::uint32_t> remove_points_beyond(const Eigen::Vector3f& centre_W_m, float radius_m);

  /// Deletes the points of `first_sweep` and of later sweeps. The indices of points change, but not the numbers of
  /// sweeps. Cost: O(number of points).
  void remove_sweeps_from(std::uint32_t first_sweep);

  std::size_t bytes() const;

  std::size_t size() const { return sigma_m_.size() - free_slots_; }
  /// Returns the upper limit of the point indices in use; exists() is false for unused indices.
  std::uint32_t index_end() const { return static_cast<std::uint32_t>(sigma_m_.size()); }
  bool exists(std::uint32_t index) const { return sigma_m_[index] >= 0.0f; }
  Eigen::Vector3f position_W_m(std::uint32_t index) const;
  float sigma_m(std::uint32_t index) const { return sigma_m_[index]; }
  std::uint32_t sweep(std::uint32_t index) const { return sweep_[index]; }
  /// Returns the scan line number of a point. Returns of one lidar ring have the same number while the lidar's attitude
  /// is constant.
  std::uint32_t line(std::uint32_t index) const { return line_[index]; }
  /// Returns the number of sweeps whose beams passed through the point, minus the number of sweeps that hit the point,
  /// limited to [0, 255].
  std::uint8_t seen_through_count(std::uint32_t index) const { return seen_through_counts_[index]; }

 private:
  static constexpr int kPointsPerChunk = 16;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct PointChunk {
    std::array<float, kPointsPerChunk> x, y, z;
    std::uint32_t next = kNone;
    std::uint32_t count = 0;
  };
  struct VoxelGroup {
    static constexpr int kBits = 3, kMask = (1 << kBits) - 1;  // a group has 8 cells along each edge
    static std::size_t row_index_of(int y, int z);
    static std::size_t cell_index_of(const Eigen::Vector3i& cell);
    static Eigen::Vector3i of(const Eigen::Vector3i& cell);

    std::array<std::uint32_t, 1u << (3 * kBits)> first;  // chunk of each cell
    std::array<std::uint8_t, 1u << (2 * kBits)> rows{};  // bit mask of the occupied cells along x
  };
  class NeighbourVoxelRows;

  bool has_room_for(const Eigen::Vector3f& position_W_m) const;
  std::uint32_t store_point(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep,
                            std::uint32_t line);
  std::uint32_t& first_chunk_of(const Eigen::Vector3i& cell);
  std::uint32_t new_chunk(std::uint32_t& first);
  void search_neighbours(std::uint32_t chunk, const Eigen::Vector3f& query_W_m, int k, float& worst_distance2_m2,
                         NearestNeighbours& found) const;

  Params params_;
  float cells_per_m_ = 0.0f;
  float cubes_per_m_ =
      0.0f;  // inverse edge length of the cubes with one point each, or of the cells if all points are kept
  SpatialHash voxel_group_index_;
  SpatialHash occupied_cubes_;
  std::vector<VoxelGroup> voxel_groups_;
  std::vector<PointChunk> point_chunks_;
  std::vector<float> sigma_m_;  // one per slot; negative: free slot
  std::vector<std::uint32_t> sweep_, line_;
  std::vector<std::uint8_t> seen_through_counts_;
  std::size_t free_slots_ = 0;
};

}  // namespace tumble

namespace tumble::mapping {

/// Assigns numbers to the scan lines of the lidar. Sweeps with equal attitude of the lidar have equal numbers, because
/// their rings coincide.
class ScanLines {
 public:
  /// Returns the number of ring 0 for a sweep with the given spin axis of the lidar, or VoxelMap::kUnknownScanLine if
  /// the lidar does not report rings.
  std::uint32_t line_number_offset(const Eigen::Vector3d& spin_axis_W, bool has_ring_numbers);
  static std::uint32_t line(std::uint32_t base, std::uint16_t ring) {
    return base == VoxelMap::kUnknownScanLine ? base : base | ring;
  }

 private:
  Eigen::Vector3d axis_W_ = Eigen::Vector3d::Zero();  // spin axis of the sweeps with equal numbers
  std::uint32_t attitude_ = 0;
};

/// Returns the points of a map. Normals are fitted to nearest neighbours, and point to the sensor that observed the
/// point. Cost: O(n).
std::vector<MapPoint> to_map_points(const VoxelMap& map, std::span<const Eigen::Vector3f> seen_from_W_m, int neighbours,
                                    double match_distance_m);

}  // namespace tumble::mapping
