// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <utility>

#include "rolling_odometry_impl.hpp"
#include "saved_rails.hpp"

namespace tumble {

namespace {

/// In a saved RollingOdometry, the saturation limits of each IMU follow after the members of SavedRolling.
struct SavedRolling {
  double radius_m = 0.0;                                  ///< stated radius
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< stated position of the merged IMU
  std::uint32_t units = 0;
  std::optional<RollingCalibration> calibration;  ///< empty before the first sample
  std::optional<PoseState> pose;                  ///< pose of the centre; the covariance omits the tilt
};

template <class Visit, class Saved>
void visit_saved(Visit& visit, Saved& saved) {
  constexpr double kConstantMax = 10.0;
  visit("radius_m", saved.radius_m);
  visit("lever_arm_m", saved.lever_arm_m);
  visit("units", saved.units);
  if (visit.present("calibration", saved.calibration)) {
    visit("constants", saved.calibration->constants, -kConstantMax, kConstantMax);
    visit("covariance of the constants", saved.calibration->covariance, -odometry::kVarianceMax,
          odometry::kVarianceMax);
  }
  if (visit.present("pose", saved.pose)) odometry::visit_pose(visit, *saved.pose);
}

}  // namespace

std::vector<std::byte> RollingOdometry::Impl::save() const {
  const auto ended = std::make_unique<Impl>(*this);
  if (state_->live.started) ended->restart_at_newest(0.0);  // needs most of the stack, so this function needs little
  if (!ended->start_) return save_at(std::nullopt);
  PoseState pose;
  pose.time_ns = state_->live.last_time_ns;
  pose.p_WA_m = ended->start_->translation();
  pose.q_WA = Eigen::Quaterniond(ended->start_->linear()).normalized();
  if (ended->restart_) pose.covariance = ended->restart_->covariance;
  return save_at(pose);
}

std::vector<std::byte> RollingOdometry::Impl::save_at(const std::optional<PoseState>& pose) const {
  SavedRolling saved{params_.radius_m, imu_merge_.p_C_m(), static_cast<std::uint32_t>(params_.units.size()), {}, pose};
  if (state_->live.started) {
    saved.calibration = RollingFilter::calibration(state_->live);
  } else if (params_.expert->rolling.filter.calibration) {
    saved.calibration = *params_.expert->rolling.filter.calibration;
  }
  odometry::SavedWriter out;
  visit_saved(out, std::as_const(saved));
  for (std::size_t k = 0; k < params_.units.size(); ++k) odometry::write_rails(rails_state_[k].rails.known, out);
  return std::move(out).finish(odometry::SavedKind::rolling);
}

Status RollingOdometry::Impl::load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose) {
  odometry::SavedReader in(odometry::SavedKind::rolling, bytes);
  SavedRolling saved;
  visit_saved(in, saved);
  if (saved.calibration) in.require_covariance("covariance of the constants", saved.calibration->covariance);
  if (saved.pose) odometry::check_pose(in, *saved.pose);
  in.require("radius_m", saved.radius_m == params_.radius_m, saved.radius_m, params_.radius_m);
  const std::size_t units = params_.units.size();
  in.require("units", saved.units == units, saved.units, double(units));
  in.require_equal("lever_arm_m", saved.lever_arm_m, imu_merge_.p_C_m());
  std::vector<SaturationLevels> rails(units);
  for (SaturationLevels& unit : rails) odometry::read_rails(in, unit);
  in.require("number of bytes after the saved state", in.left().empty(), double(in.left().size()), 0.0);
  if (!in.status().ok()) return in.status();

  Params params = params_;
  if (saved.calibration)
    params.expert->rolling.filter.calibration = std::make_shared<RollingCalibration>(*saved.calibration);
  const auto fresh = std::make_unique<Impl>(params);
  for (std::size_t k = 0; k < units; ++k) fresh->rails_.start_from(k, rails[k]);
  fresh->rails_state_ = fresh->rails_.start();
  if (saved.pose) {
    fresh->start_.emplace(Eigen::Translation3d(saved.pose->p_WA_m) * saved.pose->q_WA);
    fresh->restart_ = RollingRestart{saved.pose->p_WA_m, saved.pose->covariance};
  }
  *this = std::move(*fresh);
  if (last_pose) *last_pose = saved.pose;
  return {};
}

}  // namespace tumble
