// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <utility>

#include "rolling_odometry_impl.hpp"
#include "rolling_odometry_params.hpp"
#include "saved_saturation_levels.hpp"

namespace tumble {

namespace {

/// The bytes of a saved RollingOdometry contain the members of SavedRollingState, followed by the saturation limits of
/// each IMU.
struct SavedRollingState {
  double radius_m = 0.0;                                  ///< stated radius
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< stated position of the merged IMU
  std::uint32_t imu_count = 0;
  std::optional<RollingCalibration> calibration;  ///< empty before the first sample
  std::optional<PoseState> pose;                  ///< pose of the sphere's centre; the covariance omits the tilt
};

template <class Visit, class Saved>
void visit_saved_state(Visit& visit, Saved& saved) {
  constexpr double kConstantMax = 10.0;
  visit("radius_m", saved.radius_m);
  visit("lever_arm_m", saved.lever_arm_m);
  visit("units", saved.imu_count);
  if (visit.presence_flag("calibration", saved.calibration)) {
    visit("constants", saved.calibration->constants, -kConstantMax, kConstantMax);
    visit("covariance of the constants", saved.calibration->covariance, -odometry::kVarianceMax,
          odometry::kVarianceMax);
  }
  if (visit.presence_flag("pose", saved.pose)) odometry::visit_pose(visit, *saved.pose);
}

}  // namespace

std::vector<std::byte> RollingOdometry::Impl::save() const {
  const auto ended = std::make_unique<Impl>(*this);
  if (state_->live_filter.started) ended->restart_at_newest(0.0);
  SavedRollingState saved{
      params_.radius_m, imu_merge_.mean_imu_position_m(), static_cast<std::uint32_t>(params_.imus.size()), {}, {}};
  if (ended->start_) {
    PoseState& pose = saved.pose.emplace();
    pose.time_ns = state_->live_filter.last_time_ns;
    pose.position_W_m = ended->start_->translation();
    pose.orientation_W = Eigen::Quaterniond(ended->start_->linear()).normalized();
    if (ended->restart_) pose.covariance = ended->restart_->covariance;
  }
  if (state_->live_filter.started) {
    saved.calibration = RollingFilter::calibration(state_->live_filter);
  } else if (params_.expert->rolling.filter.calibration) {
    saved.calibration = *params_.expert->rolling.filter.calibration;
  }
  odometry::SavedStateWriter out;
  visit_saved_state(out, std::as_const(saved));
  for (std::size_t k = 0; k < params_.imus.size(); ++k)
    odometry::write_saturation_levels(clipping_states_[k].clipping_state.known_limits, out);
  return std::move(out).finish(odometry::SavedStateKind::rolling);
}

Status RollingOdometry::Impl::load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose) {
  odometry::SavedStateReader in(odometry::SavedStateKind::rolling, bytes);
  SavedRollingState saved;
  visit_saved_state(in, saved);
  if (saved.calibration) in.require_covariance("covariance of the constants", saved.calibration->covariance);
  if (saved.pose) odometry::check_pose(in, *saved.pose);
  in.require_condition("radius_m", saved.radius_m == params_.radius_m, saved.radius_m, params_.radius_m);
  const std::size_t units = params_.imus.size();
  in.require_condition("units", saved.imu_count == units, saved.imu_count, double(units));
  in.require_equal("lever_arm_m", saved.lever_arm_m, imu_merge_.mean_imu_position_m());
  std::vector<SaturationLevels> rails(units);
  for (SaturationLevels& unit : rails) odometry::read_saturation_levels(in, unit);
  in.require_condition("number of bytes after the saved state", in.remaining_bytes().empty(),
                       double(in.remaining_bytes().size()), 0.0);
  if (!in.status().ok()) return in.status();

  Params params = params_;
  if (saved.calibration)
    params.expert->rolling.filter.calibration = std::make_shared<RollingCalibration>(*saved.calibration);
  const auto fresh = std::make_unique<Impl>(params);
  fresh->clipping_finders_ = odometry::clipping_finders_of(params, rails);
  fresh->start_clipping_states();
  if (saved.pose) {
    fresh->start_.emplace(Eigen::Translation3d(saved.pose->position_W_m) * saved.pose->orientation_W);
    fresh->restart_ = RollingRestart{saved.pose->position_W_m, saved.pose->covariance};
  }
  *this = std::move(*fresh);
  if (last_pose) *last_pose = saved.pose;
  return {};
}

}  // namespace tumble
