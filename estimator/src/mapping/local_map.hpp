// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// FreeSpaceGrid stores the range of the nearest return of a sweep in each direction. The directions are divided into
/// bins on the faces of a cube around the sensor. The beams of a sweep passed through a map point if all returns in
/// nearly the same direction are farther away: mapping.md (R65).
class FreeSpaceGrid {
 public:
  /// `from_W_m` is the assumed origin of all beams of a sweep. `moved_m` is the largest distance of the sensor from
  /// `from_W_m` during the sweep.
  void start(const Eigen::Vector3f& from_W_m, float moved_m);
  void add(const Eigen::Vector3f& return_W_m);

  enum class Verdict { unknown_space, occupied, free_space };
  /// Checks whether beams of the sweep hit a map point, or passed through its position. Cost: O(1).
  Verdict verdict(const Eigen::Vector3f& point_W_m, float sigma_m) const;

 private:
  static constexpr int kBins = 60;  // number of bins along an edge: 1 to 2 deg per bin
  struct Direction {
    int cube_face, column, row;
    std::size_t direction_bin_index() const {
      return static_cast<std::size_t>((cube_face * kBins + row) * kBins + column);
    }
  };
  static std::optional<Direction> direction(const Eigen::Vector3f& lever_m);
  float free_space_range_m(const Direction& towards) const;

  Eigen::Vector3f origin_W_m_ = Eigen::Vector3f::Zero();
  float range_min_m_ = 0.0f;
  std::vector<float> nearest_return_m_;  // infinity for a direction without a return
};

struct InsertedPoint {
  std::uint32_t index;  ///< index of the point in the map
  SweepPoint point;     ///< point with the calibration at insertion
};

struct SweepToInsert {
  const SweepTrajectory& trajectory;
  const Registration::Matrix& covariance;
  std::span<const SweepPoint> points;
  bool has_ring_numbers;
  bool is_pose_certain;  ///< whether the free space of the sweep may contradict map points
};

/// LocalMap contains the map points around the sensor. For each map point, LocalMap stores its scan line and the sensor
/// position at which the lidar measured the point.
class LocalMap {
 public:
  using Params = LidarInertialOdometry::Params;

  explicit LocalMap(const Params& params) : map_({params.expert.map.voxel_m, params.expert.map.spacing_m}) {}

  const VoxelMap& voxels() const { return map_; }
  bool empty() const { return map_.size() == 0; }

  /// Adds the points of a sweep to the map and to the list `inserted`. Cost: O(points of the map). `noise` computes the
  /// variance of a lidar return. If the pose is certain, the function counts for each map point whether beams of the
  /// sweep hit or passed through the position of the map point.
  std::size_t insert(const Params& params, const SweepToInsert& sweep, const Registration& noise,
                     std::vector<InsertedPoint>& inserted);
  /// Moves inserted map points to their positions on the refined trajectory: mapping.md (R3). `later_s` is the change
  /// of the lidar's estimated time offset since the points were inserted.
  void move(const SweepTrajectory& trajectory, const Eigen::Isometry3d& T_IL, double later_s,
            std::span<const InsertedPoint> inserted);

  /// Replaces the map by a prior map. Each point of the prior map gets a fictitious distant sensor position, on the map
  /// axis nearest to the point's normal. Surface normals that are later estimated from the map keep their signs due to
  /// the fictitious sensor positions. If `T_MW` is given, the points of the local map are transformed to the prior
  /// map's frame and added.
  void start_from_map_points(const Params& params, std::span<const MapPoint> points, const Eigen::Isometry3f* T_MW);

  std::uint32_t sweeps() const { return static_cast<std::uint32_t>(seen_from_W_m_.size()); }
  /// Removes the points of the sweep with the number `first_sweep` and of all later sweeps, and changes the indices of
  /// map points. Cost: O(points).
  void remove_sweeps_since(std::uint32_t first_sweep);

  /// Removes map points far from the sensor, if the sensor has moved far enough since the last removal. Returns whether
  /// the indices of map points have changed.
  bool prune(const Params& params, const Eigen::Vector3d& p_WI_m);

  std::size_t bytes() const { return map_.bytes() + seen_from_W_m_.capacity() * sizeof(Eigen::Vector3f); }
  std::vector<MapPoint> to_map_points(const Params& params) const;

 private:
  void check_free_space(const FreeSpaceGrid& sight);

  VoxelMap map_;
  std::vector<Eigen::Vector3f> seen_from_W_m_;  // sensor position of each sweep with map points
  Eigen::Vector3f last_pruning_position_W_m_ = Eigen::Vector3f::Zero();
  ScanLines scan_lines_;
  std::vector<Eigen::Vector3f> levers_W_m_;
  FreeSpaceGrid free_space_;
};

}  // namespace tumble::mapping
