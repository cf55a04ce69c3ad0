// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "prior_scene.hpp"

namespace tumble::mapping {

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

}  // namespace tumble::mapping
