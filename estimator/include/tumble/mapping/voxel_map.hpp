// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"

namespace tumble {

class StateWriter;
class StateReader;
class StateLayout;

/// Result of a neighbour search: the nearest points of a map, nearest first.
struct Neighbours {
  static constexpr int kMax = 32;
  int count = 0;
  std::array<float, kMax> distance2_m2;
  std::array<std::uint32_t, kMax> index;  ///< index of the point in its VoxelMap
};

/// Stores points in the world and finds nearest neighbours. Sweeps extend the map one by one.
///
/// Cells of a cubic grid store their points in chunks of sixteen, one array per coordinate, so that distances are
/// computed over contiguous floats. One hash look-up finds a group of 8x8x8 cells. At most one point is kept per cube
/// of the spacing. A copy equals the original and is independent of it. Coordinates are single-precision floats, which
/// limits the width of a map to a few kilometres.
class VoxelMap {
 public:
  /// Mark of a point without a known scan line.
  static constexpr std::uint32_t kNoLine = 0xffffffffu;
  /// Invalid point index.
  static constexpr std::uint32_t kNoPoint = 0xffffffffu;

  struct Params {
    double voxel_m = 0.5;    ///< edge of a cell; a few times the spacing searches fastest
    double spacing_m = 0.1;  ///< edge of the cubes in which at most one point is kept; 0 keeps all points

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.voxel_m, {"voxel_m", "m", 0.01, 100.0, "edge of a cell; search is fastest at a few times the spacing"});
      visit(p.spacing_m,
            {"spacing_m", "m", 0.0, 100.0, "edge of the cube that stores at most one point; 0: store all"});
    }
  };

  explicit VoxelMap(const Params& params);

  /// Adds a point unless its cube is occupied. `sigma_m` is the uncertainty of the point's position. `sweep` and `line`
  /// are labels that sweep() and line() return. Returns whether the point was added. Points that are not finite or
  /// beyond 2^20 cells are not added.
  bool insert(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep, std::uint32_t line = kNoLine) {
    return add(position_W_m, sigma_m, sweep, line) != kNoPoint;
  }

  /// Adds a point unless its cube is occupied. Returns the point's index, or kNoPoint if the point was not added.
  std::uint32_t add(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep, std::uint32_t line);
  /// Returns whether add() would reject a point, because its cube is occupied or the point is out of the map's range. A
  /// caller can thus skip computing a point's properties.
  bool is_taken(const Eigen::Vector3f& position_W_m) const;

  /// Moves a point to a refined position. If the point would leave its cell, move() returns false and leaves the point
  /// unchanged.
  bool move(std::uint32_t index, const Eigen::Vector3f& position_W_m);

  /// Counts a sweep that saw through a point's position or observed the point again. Observations through the point and
  /// of the point cancel each other.
  void count_sight(std::uint32_t index, bool through);

  /// Finds the k <= Neighbours::kMax nearest points within `radius_m`. Equal distances within a cell are in order of
  /// insertion. The search is exact and does not allocate. The cost grows with the number of cells that the final
  /// radius touches.
  void nearest(const Eigen::Vector3f& query_W_m, int k, float radius_m, Neighbours& found) const;

  /// Deletes the points farther than `radius_m` from `centre_W_m` and frees their memory. Indices change. The remaining
  /// sweeps are renumbered in order. Returns the old number of each remaining sweep. Cost: O(number of points).
  std::vector<std::uint32_t> keep_within(const Eigen::Vector3f& centre_W_m, float radius_m);

  /// Deletes the points of `first_sweep` and later sweeps. Indices change; sweeps keep their numbers. O(number of
  /// points).
  void keep_before(std::uint32_t first_sweep);

  /// Returns the memory in use [bytes].
  std::size_t bytes() const;

  /// Saves the points and the occupied cubes: 25 bytes per point and 8 per cube. The search structure is rebuilt on
  /// loading.
  void save(StateWriter& out) const;
  /// Replaces the contents of the map by a saved map of equal parameters. The reader reports `out_of_range` for
  /// positions that are not possible.
  void load(StateReader& in);
  static void describe(StateLayout& out);

  std::size_t size() const { return sigma_m_.size() - vacant_; }
  /// Returns the upper limit of the indices in use. Indices for which exists() is false are free slots of chunks.
  std::uint32_t index_end() const { return static_cast<std::uint32_t>(sigma_m_.size()); }
  bool exists(std::uint32_t index) const { return sigma_m_[index] >= 0.0f; }
  Eigen::Vector3f position_W_m(std::uint32_t index) const;
  float sigma_m(std::uint32_t index) const { return sigma_m_[index]; }
  std::uint32_t sweep(std::uint32_t index) const { return sweep_[index]; }
  /// Returns the scan line of a point. Returns of one ring share a number while the sensor's attitude is constant.
  std::uint32_t line(std::uint32_t index) const { return line_[index]; }
  /// Returns the number of sweeps that saw through the point minus the number that observed the point, within 0 and
  /// 255.
  std::uint8_t seen_through(std::uint32_t index) const { return seen_through_[index]; }

 private:
  static constexpr int kChunk = 16;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Chunk {
    std::array<float, kChunk> x, y, z;
    std::uint32_t next = kNone;
    std::uint32_t count = 0;
  };
  struct Group {
    static constexpr int kBits = 3, kMask = (1 << kBits) - 1;  // 8 cells along each edge
    static std::size_t row_of(int y, int z);
    static std::size_t place_of(const Eigen::Vector3i& cell);
    static Eigen::Vector3i of(const Eigen::Vector3i& cell);  // group of a cell

    std::array<std::uint32_t, 1u << (3 * kBits)> first;  // chunk of each cell
    std::array<std::uint8_t, 1u << (2 * kBits)> rows{};  // bit mask of the occupied cells along x
  };
  class Rows;

  bool has_room_for(const Eigen::Vector3f& position_W_m) const;
  std::uint32_t put(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep, std::uint32_t line);
  std::uint32_t& first_of(const Eigen::Vector3i& cell);
  std::uint32_t new_chunk(std::uint32_t& first);
  void search(std::uint32_t chunk, const Eigen::Vector3f& query_W_m, int k, float& worst2, Neighbours& found) const;
  void load_chunk(StateReader& in);

  Params params_;
  float cells_per_m_ = 0.0f;
  float cubes_per_m_ = 0.0f;  // for cubes of the spacing; for cells if all points are kept
  SpatialHash groups_of_;
  SpatialHash taken_;
  std::vector<Group> groups_;
  std::vector<Chunk> chunks_;
  std::vector<float> sigma_m_;  // per slot of the chunks; negative: free
  std::vector<std::uint32_t> sweep_, line_;
  std::vector<std::uint8_t> seen_through_;
  std::size_t vacant_ = 0;
};

}  // namespace tumble
