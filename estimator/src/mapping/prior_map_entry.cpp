// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <variant>

#include "frame_change.hpp"
#include "odometry_impl.hpp"

namespace tumble {

Status LidarInertialOdometry::set_prior_map(PriorMap map) {
  if (const Status status = check_prior_map(map); !status.ok()) return status;
  if (mapping::has_started(impl_->tracking))
    return {ErrorCode::time_order, "number of sweeps before the prior map", 1.0, 0.0};
  if (map.start_T_MI) set_start_pose(*map.start_T_MI);
  impl_->localiser = mapping::MapLocaliser(std::move(map));
  return {};
}

void LidarInertialOdometry::copy_prior_map(const LidarInertialOdometry& other) {
  impl_->localiser = other.impl_->localiser;
  impl_->localiser.restart(impl_->start_pose);
  const PriorMap* const map = prior_map();
  if (!impl_->start_pose && map != nullptr && map->start_T_MI) set_start_pose(*map->start_T_MI);
}

Status LidarInertialOdometry::check_localised() const {
  return impl_->localiser.status();
}

Status LidarInertialOdometry::convert_to_prior_map_frame(std::span<PoseState> poses) const {
  if (!impl_->poses_before_localisation)
    return {ErrorCode::degenerate, "number of localisations in a prior map", 0.0, 1.0};
  for (PoseState& pose : poses) impl_->poses_before_localisation->apply(pose);
  return {};
}

const PriorMap* LidarInertialOdometry::prior_map() const {
  return impl_->localiser.has_map() ? &impl_->localiser.map() : nullptr;
}

/// After a tracking failure, or while a relocalisation is unconfirmed, the local map may be wrong and is not compared
/// with the prior map.
void LidarInertialOdometry::Impl::localise(const SweepResult& report) {
  if (!localiser.has_map() || localiser.is_localised()) return;
  if (report.verdict != SweepVerdict::registered || !std::holds_alternative<mapping::Tracking>(tracking)) return;
  const std::optional<mapping::FramePose> pose =
      localiser.match_local_map(map.voxels(), sweep_boundary.state_estimate.mean.state.p_WI_m);
  if (pose) enter_prior_map(*pose, report.pose);
}

void LidarInertialOdometry::Impl::enter_prior_map(const mapping::FramePose& pose, const PoseState& last) {
  const Eigen::Vector3d sensor_M_m = pose.T_prior_map_world * sweep_boundary.state_estimate.mean.state.p_WI_m;
  const mapping::FrameChange change{pose.T_prior_map_world, pose.covariance, sensor_M_m};
  poses_before_localisation.emplace(change, last);
  change.apply(sweep_boundary);
  change.apply(window);
  window.clear_inserted();  // the indices of the points change
  const Eigen::Isometry3f T_MW = pose.T_prior_map_world.cast<float>();
  map.start_from_map_points(params, localiser.map().points, localiser.map().extend ? &T_MW : nullptr);
  world_covariance = mapping::WorldCovariance::covariance_in_prior_map(params.expert.world_covariance, sensor_M_m);
}

}  // namespace tumble
