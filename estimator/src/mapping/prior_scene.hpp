// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/types.hpp"

/// See mapping.md, "Localisation in a prior map".

namespace tumble::mapping {

/// A list of surface points contains at most one point per cube of 1 m, so that the errors of the points are nearly
/// independent.
struct SurfacePoint {
  Eigen::Vector3f position_W_m;
  Eigen::Vector3f normal_W;
};

/// Returns points on planar surfaces within `radius_m` of `p_WI_m`, nearest first.
std::vector<SurfacePoint> surface_points(const VoxelMap& map, const Eigen::Vector3f& p_WI_m, float radius_m);

struct FramePose {
  Eigen::Isometry3d T_prior_map_world = Eigen::Isometry3d::Identity();
  std::size_t covered_point_count = 0;   ///< surface points near the prior map's surfaces
  std::size_t agreeing_point_count = 0;  ///< covered points on the prior map's surfaces, with similar normals
  /// 6x6 covariance of the sensor's position error and rotation error, in axes of the prior map
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  double agreement_ratio() const {
    return covered_point_count == 0 ? 0.0 : double(agreeing_point_count) / double(covered_point_count);
  }
};

/// SearchRegion limits the position of the sensor and the heading of the local map frame W, each in the prior map frame
/// M.
struct SearchRegion {
  Eigen::Vector3d p_WI_m = Eigen::Vector3d::Zero();                 ///< sensor position to which the limits refer, in W
  Eigen::Vector3d centre_in_prior_map_m = Eigen::Vector3d::Zero();  ///< centre of the region
  double search_radius_m = 0.0, search_angle_rad = 0.0;
};

class PriorMapScene {
 public:
  explicit PriorMapScene(PriorMap map);

  const PriorMap& map() const { return map_; }
  /// Returns at most two distinct poses of the local map frame in the prior map, best first. Cost of a search in the
  /// whole map: O(surface area of the map), about a second for a map of 100 m.
  ///
  /// @param sensor_W_m  sensor position in the local frame
  /// @param attempt     number of the search; selects the point of `points` that is placed on surfaces of the prior map
  /// @param region      limits of the search; null: the whole map
  /// @param tried       receives the number of poses that the search compared
  std::vector<FramePose> find_candidate_poses(const std::vector<SurfacePoint>& points,
                                              const Eigen::Vector3d& sensor_W_m, std::size_t attempt,
                                              const SearchRegion* region, std::size_t& tried) const;
  /// Refines a pose by point-to-plane registration, and counts the surface points that agree with the prior map.
  FramePose refined_pose(const FramePose& start, const std::vector<SurfacePoint>& points,
                         const Eigen::Vector3d& sensor_W_m, float first_kernel_m) const;

 private:
  struct PoseCandidate {
    int pose_score;
    std::uint32_t grid_cell_index;
    std::uint16_t yaw;
  };
  struct SurfaceCell {
    Eigen::Vector3f position_prior_map_m;
    float normal_z;
    std::int64_t at;
  };
  void build_grid();
  std::int64_t index_of(const Eigen::Vector3f& position_M_m) const;
  std::vector<PoseCandidate> best_candidates(const std::vector<SurfacePoint>& points, const SurfacePoint& anchor,
                                             const SearchRegion* region, std::size_t& tried) const;
  Eigen::Isometry3d pose_of(const PoseCandidate& candidate, const SurfacePoint& anchor) const;
  void count(const std::vector<SurfacePoint>& points, FramePose& pose) const;

  PriorMap map_;
  VoxelMap voxels_;
  std::vector<Eigen::Vector3f> normals_;  // by index of voxels_
  float cell_m_ = 0.0f;
  Eigen::Vector3f lower_corner_prior_map_m_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> grid_;
  std::vector<SurfaceCell> cells_;
};

/// maximum distance from the sensor of surface points that are compared with the prior map
inline constexpr float kQueryRadius_m = 20.0f;

/// MapLocaliser estimates the pose of the local map frame W in the frame M of a prior map: mapping.md, "Localisation in
/// a prior map".
///
/// A pose is accepted when several successive sweeps have passed a statistical test, and rejected after two failed
/// tests.
class MapLocaliser {
 public:
  MapLocaliser() = default;
  explicit MapLocaliser(PriorMap map) : prior_scene_(std::make_shared<const PriorMapScene>(std::move(map))) {}

  bool has_map() const { return prior_scene_ != nullptr; }
  bool is_localised() const { return localised_; }
  const PriorMap& map() const { return prior_scene_->map(); }
  /// Restarts the localisation in the prior map. If the IMU pose `T_MI` in the prior map is given, the search is
  /// limited to the region around this pose.
  void restart(const std::optional<Eigen::Isometry3d>& T_MI);

  /// Returns the pose of the local map frame in the prior map when three successive sweeps have confirmed this pose.
  /// Cost: a few milliseconds. While no pose is proposed, every fifth call takes about a second.
  std::optional<FramePose> match_local_map(const VoxelMap& local, const Eigen::Vector3d& p_WI_m);
  /// Returns `degenerate` if the robot is not localised in the prior map.
  Status status() const;

 private:
  void propose_map_pose(const std::vector<SurfacePoint>& points, const Eigen::Vector3d& p_WI_m);
  bool matches_prior_map(const FramePose& pose) const;

  std::shared_ptr<const PriorMapScene> prior_scene_;
  bool localised_ = false;
  std::optional<Eigen::Isometry3d> T_prior_map_world_;  // proposed pose
  double random_agreement_fraction_ = 0.0;  // fraction of surface points that agree with the prior map at a wrong pose
  double compared_pose_count_ = 1.0;        // number of poses that the search compared
  int successive_passed_tests_ = 0, successive_failed_tests_ = 0;  // successive sweeps that passed or failed the test
  int attempts_ = 0, sweeps_since_search_ = 0;
};

/// FrameChange converts estimates from the local map frame W to the frame M of a prior map.
struct FrameChange {
  Eigen::Isometry3d T_prior_map_world;
  /// covariance of the transform from the local frame W to the prior map frame M, in axes of M: displacement and
  /// rotation of frame W about the point `sensor_in_prior_map_m`
  Eigen::Matrix<double, 6, 6> covariance;
  Eigen::Vector3d sensor_in_prior_map_m;

  void apply(SweepBoundary& boundary) const;
  void apply(LagWindow& window) const;

 private:
  void apply(Registration::Estimate& mean) const;
  void apply(const Registration::Estimate& mean, Registration::Matrix& of_all) const;
  Registration::Matrix rotation() const;
};

/// PosesBeforeChange transforms poses from before the localisation to the frame M of the prior map.
class PosesBeforeChange {
 public:
  /// `last` is the pose in the local map frame W at the time of the localisation in the prior map.
  PosesBeforeChange(const FrameChange& change, const PoseState& last);

  /// Computes the covariance of an earlier pose from the covariance of the last pose and the displacement between the
  /// two poses.
  void apply(PoseState& pose) const;

 private:
  Eigen::Isometry3d T_prior_map_world_;
  Eigen::Vector3d last_M_m_;                       // position of the last pose
  Eigen::Matrix<double, 6, 6> last_covariance_M_;  // covariance of the last pose
};

}  // namespace tumble::mapping
