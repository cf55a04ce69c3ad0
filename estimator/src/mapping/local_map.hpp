// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "sight_grid.hpp"
#include "tumble/mapping/deskew.hpp"
#include "tumble/mapping/detail/map_drawing.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/registration.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble::mapping {

/// A point of a sweep in the map.
struct InsertedPoint {
  std::uint32_t index;  ///< in the map
  SweepPoint point;     ///< by the calibration that it was inserted with
};

/// A sweep that goes into the map.
struct SweepToInsert {
  const SweepTrajectory& trajectory;
  const Registration::Matrix& covariance;  ///< of its unknowns
  std::span<const SweepPoint> points;
  bool rings_differ;
  bool sure_of_place;  ///< what it saw through may be held against the map
};

/// The map about the sensor: its points, where each was seen from, and the scan lines that they lie on.
class LocalMap {
 public:
  using Params = LidarInertialOdometry::Params;

  explicit LocalMap(const Params& params) : map_({params.expert.map.voxel_m, params.expert.map.spacing_m}) {}

  const VoxelMap& voxels() const { return map_; }
  bool empty() const { return map_.size() == 0; }

  /// Adds the points of a sweep; `inserted` gets those that were added, appended. `noise` tells a return's own
  /// variance. A sweep that is sure of its place is held against each point of the map: O(points of the map).
  std::size_t insert(const Params& params, const SweepToInsert& sweep, const Registration& noise,
                     std::vector<InsertedPoint>& inserted);
  /// Moves points to where their sweep is now known to have seen them, with `later_s` added to their times, mapping.md
  /// (R3).
  void move(const SweepTrajectory& trajectory, const Eigen::Isometry3d& T_IL, double later_s,
            std::span<const InsertedPoint> inserted);

  /// Sweeps that gave points, by whose number each point is known.
  std::uint32_t sweeps() const { return static_cast<std::uint32_t>(seen_from_W_m_.size()); }
  /// Takes back what the sweeps from this number on drew. Indices have changed. O(number of points).
  void withdraw(std::uint32_t first_sweep);

  /// Forgets what is out of reach once the sensor has moved far enough; then true, and indices have changed.
  bool prune(const Params& params, const Eigen::Vector3d& p_WI_m);

  std::size_t bytes() const { return map_.bytes() + seen_from_W_m_.capacity() * sizeof(Eigen::Vector3f); }
  std::vector<MapPoint> with_normals(const Params& params) const;

  /// Whether each point was inserted by a sweep that it knows, as all of a map that was loaded have to be.
  bool knows_its_sweeps() const;
  /// Stated once: `mapping_members.hpp`.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  /// Holds each point against how far the sweep saw.
  void look_through(const SightGrid& sight);

  VoxelMap map_;
  std::vector<Eigen::Vector3f> seen_from_W_m_;  // per sweep that gave points
  Eigen::Vector3f pruned_at_W_m_ = Eigen::Vector3f::Zero();
  ScanLines scan_lines_;
  std::vector<Eigen::Vector3f> levers_W_m_;  // memory
  SightGrid sight_;                          // memory
};

}  // namespace tumble::mapping
