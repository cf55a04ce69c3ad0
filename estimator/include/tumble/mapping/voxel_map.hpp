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
  std::array<std::uint32_t, kMax> index;  ///< of the point in its VoxelMap
};

/// Points in the world, grown sweep by sweep, searched by position.
///
/// Cells of a cubic grid hold their points in chunks of sixteen, coordinate by coordinate, so that distances are
/// computed over contiguous floats; groups of 8x8x8 cells are found by one look-up in a hash table. Points are thinned
/// to at most one per cube of the spacing. Copies are independent and equal. Coordinates are floats: a map is a few
/// kilometres wide.
class VoxelMap {
 public:
  /// Mark of a point that is on no known scan line.
  static constexpr std::uint32_t kNoLine = 0xffffffffu;
  /// Mark of no point.
  static constexpr std::uint32_t kNoPoint = 0xffffffffu;

  struct Params {
    double voxel_m = 0.5;    ///< edge of a cell; a few times the spacing searches fastest
    double spacing_m = 0.1;  ///< at most one point is kept per cube of this edge; 0 keeps all

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.voxel_m, {"voxel_m", "m", 0.01, 100.0, "edge of a cell; search is fastest at a few times the spacing"});
      visit(p.spacing_m,
            {"spacing_m", "m", 0.0, 100.0, "edge of the cube that stores at most one point; 0: store all"});
    }
  };

  explicit VoxelMap(const Params& params);

  /// Adds a point unless its cube is taken. `sigma_m` is the uncertainty of its position; `sweep` and `line` are marks
  /// that come back from sweep() and line(). Returns whether it was added. Points that are not finite or beyond 2^20
  /// cells are not added.
  bool insert(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep, std::uint32_t line = kNoLine) {
    return add(position_W_m, sigma_m, sweep, line) != kNoPoint;
  }

  /// The same; returns the point's index, or kNoPoint where it was not added.
  std::uint32_t add(const Eigen::Vector3f& position_W_m, float sigma_m, std::uint32_t sweep, std::uint32_t line);
  /// Whether add() would find the place taken, or out of the map's range: what a point is worth need not be known then.
  bool is_taken(const Eigen::Vector3f& position_W_m) const;

  /// Moves a point that is now known better. Where it would leave its cell it stays where it was, and false is
  /// returned.
  bool move(std::uint32_t index, const Eigen::Vector3f& position_W_m);

  /// A sweep saw through the place of a point, or saw the point again: each takes back one of the other.
  void count_sight(std::uint32_t index, bool through);

  /// The k <= Neighbours::kMax nearest points within `radius_m`; equal distances in order of insertion within a cell.
  /// Exact. Does not allocate; cost grows with the number of cells that the final radius touches.
  void nearest(const Eigen::Vector3f& query_W_m, int k, float radius_m, Neighbours& found) const;

  /// Forgets the points farther than `radius_m` from `centre` and gives their memory back. Indices change; the sweeps
  /// that remain are renumbered in order, and the old number of each is returned. O(number of points).
  std::vector<std::uint32_t> keep_within(const Eigen::Vector3f& centre_W_m, float radius_m);

  /// Forgets the points of this sweep and later ones. Indices change, sweeps keep their numbers. O(number of points).
  void keep_before(std::uint32_t first_sweep);

  /// Memory held [bytes].
  std::size_t bytes() const;

  /// The points, and which cubes of the spacing are taken: 25 bytes a point and 8 a cube. What finds them is built
  /// anew.
  void save(StateWriter& out) const;
  /// In place of what there is, into a map of the same parameters. Trouble of the reader: `out_of_range` where points
  /// lie where none can.
  void load(StateReader& in);
  static void describe(StateLayout& out);

  std::size_t size() const { return sigma_m_.size() - vacant_; }
  /// Indices handed out are below this; those that exists() refuses are free places inside of chunks.
  std::uint32_t index_end() const { return static_cast<std::uint32_t>(sigma_m_.size()); }
  bool exists(std::uint32_t index) const { return sigma_m_[index] >= 0.0f; }
  Eigen::Vector3f position_W_m(std::uint32_t index) const;
  float sigma_m(std::uint32_t index) const { return sigma_m_[index]; }
  std::uint32_t sweep(std::uint32_t index) const { return sweep_[index]; }
  /// Scan line of a point: returns of one ring while the sensor holds its attitude share a number.
  std::uint32_t line(std::uint32_t index) const { return line_[index]; }
  /// Sweeps that saw through its place, less those that saw it; at most 255, at least 0.
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
    static Eigen::Vector3i of(const Eigen::Vector3i& cell);  // which group

    std::array<std::uint32_t, 1u << (3 * kBits)> first;  // chunk of each cell
    std::array<std::uint8_t, 1u << (2 * kBits)> rows{};  // a bit for each cell along x that holds points
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
  float cubes_per_m_ = 0.0f;  // of the spacing; of the cells where all are kept
  SpatialHash groups_of_;
  SpatialHash taken_;
  std::vector<Group> groups_;
  std::vector<Chunk> chunks_;
  std::vector<float> sigma_m_;  // per place in the chunks; negative: free
  std::vector<std::uint32_t> sweep_, line_;
  std::vector<std::uint8_t> seen_through_;
  std::size_t vacant_ = 0;
};

}  // namespace tumble
