// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <utility>

#include "saved_saturation_levels.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"
#include "tumbling_odometry_impl.hpp"
#include "tumbling_odometry_params.hpp"

namespace tumble {

namespace {

/// A saved TumblingOdometry contains a SavedTumblingState, followed by the map in the format of save_map().
struct SavedTumblingState {
  Eigen::Vector3d lever_arm_I_m = Eigen::Vector3d::Zero();        ///< stated lever arm
  Eigen::Isometry3d stated_T_IL = Eigen::Isometry3d::Identity();  ///< stated mounting of the lidar
  std::optional<BodyImuCalibration> rig;                          ///< empty if the rig constants were not estimated
  std::optional<KnownSensorErrors> sensor_errors;
  SaturationLevels saturation_levels;
  LidarImuCalibrationPrior lidar;  ///< estimated mounting and time offset, with standard deviations
  std::optional<PoseState> pose;
  bool extend = true;  ///< PriorMap::extend
};

template <class Visit, class Rig>
void visit_rig(Visit& visit, Rig& rig) {
  constexpr double kMost = BodyImuConstants::kMaxConstantMagnitude;
  visit("lever_arm_m", rig.constants.lever_arm_m, -kMost, kMost);
  visit("gyro_bias_rad_s", rig.constants.gyro_bias_rad_s, -kMost, kMost);
  visit("accel_bias_m_s2", rig.constants.accel_bias_m_s2, -kMost, kMost);
  visit("inertia", rig.constants.inertia_coordinates, -kMost, kMost);
  visit("gyro elements", rig.constants.gyro_misalignment, -kMost, kMost);
  visit("calibration covariance", rig.covariance);
}

template <class Visit, class Errors>
void visit_sensor_errors(Visit& visit, Errors& known) {
  visit("gyro error", known.errors.gyro);
  visit("accelerometer error", known.errors.accel);
  visit("g_sensitivity_s_m", known.errors.g_sensitivity_s_m);
  visit("accel_delay_s", known.errors.accel_delay_s);
  visit("accel_filter_time_variance_s2", known.errors.accel_filter_time_variance_s2);
  visit("covariance of the sensor errors", known.covariance);
}

template <class Visit, class Lidar>
void visit_lidar(Visit& visit, Lidar& lidar) {
  visit("T_IL", lidar.calibration.T_IL);
  visit("time_offset_s", lidar.calibration.imu_minus_lidar_clock_s);
  visit("mount_sigma_rad", lidar.mount_sigma_rad);
  visit("mount_sigma_m", lidar.mount_sigma_m);
  visit("time_offset_sigma_s", lidar.time_offset_sigma_s);
}

std::vector<std::byte> write_saved_state(const SavedTumblingState& saved, std::span<const MapPoint> map) {
  odometry::SavedStateWriter out;
  out("lever_arm_m", saved.lever_arm_I_m);
  out("T_IL", saved.stated_T_IL);
  if (out.presence_flag("calibration", saved.rig)) visit_rig(out, *saved.rig);
  if (out.presence_flag("sensor errors", saved.sensor_errors)) visit_sensor_errors(out, *saved.sensor_errors);
  odometry::write_saturation_levels(saved.saturation_levels, out);
  visit_lidar(out, saved.lidar);
  if (out.presence_flag("pose", saved.pose)) odometry::visit_pose(out, *saved.pose);
  out("extend", saved.extend);
  out.append_bytes(save_map(map));
  return std::move(out).finish(odometry::SavedStateKind::tumbling);
}

/// Returns an error if the lever arm or the lidar mounting of the saved run differs from `lever_arm_I_m` or `T_IL`.
Status read(std::span<const std::byte> bytes, const Eigen::Vector3d& lever_arm_I_m, const Eigen::Isometry3d& T_IL,
            SavedTumblingState& saved, std::vector<MapPoint>& map) {
  odometry::SavedStateReader in(odometry::SavedStateKind::tumbling, bytes);
  in("lever_arm_m", saved.lever_arm_I_m);
  in("T_IL", saved.stated_T_IL);
  if (in.presence_flag("calibration", saved.rig)) visit_rig(in, *saved.rig);
  if (in.presence_flag("sensor errors", saved.sensor_errors)) visit_sensor_errors(in, *saved.sensor_errors);
  odometry::read_saturation_levels(in, saved.saturation_levels);
  visit_lidar(in, saved.lidar);
  if (in.presence_flag("pose", saved.pose)) odometry::visit_pose(in, *saved.pose);
  if (saved.pose) odometry::check_pose(in, *saved.pose);
  in("extend", saved.extend);
  in.require_equal("lever_arm_m", saved.lever_arm_I_m, lever_arm_I_m);
  in.require_equal("T_IL", saved.stated_T_IL.matrix(), T_IL.matrix());
  if (!in.status().ok()) return in.status();
  if (saved.rig) {
    if (const Status status = check_body_imu_calibration(*saved.rig); !status.ok()) return status;
  }
  if (saved.sensor_errors) {
    if (const Status status = check_known_errors(*saved.sensor_errors); !status.ok()) return status;
  }
  return load_map(in.remaining_bytes(), map);
}

/// The standard deviations of the start pose determine the size of the search region in the prior map.
void set_prior_pose(const PoseState& pose, PriorMap& map) {
  Eigen::Isometry3d T_MI = Eigen::Isometry3d::Identity();
  T_MI.linear() = pose.orientation_W.toRotationMatrix();
  T_MI.translation() = pose.position_W_m;
  map.start_T_MI = T_MI;
  map.start_position_sigma_m = std::sqrt(pose.covariance.diagonal().head<3>().maxCoeff());
  map.start_heading_sigma_rad = std::sqrt(pose.covariance(5, 5));
}

/// If the saved run was not localised in the prior map, the saved covariance includes the uncertainty of the start
/// pose.
std::optional<PoseState> newest_or_start_pose(const TumblingOdometry::Impl& odometry) {
  const LidarInertialOdometry& mapper = odometry.mapper();
  const std::optional<Eigen::Isometry3d>& start = mapper.start_pose();
  const bool in_map = mapper.check_localised().ok();
  PoseState out;
  const bool moved = odometry.newest(out).ok() || mapper.predict({}, {}, out).ok();
  if (!start && (!moved || !in_map)) return std::nullopt;
  if (!moved) {
    out.time_ns = odometry.newest_ns_.value_or(0);
    out.position_W_m = start->translation();
    out.orientation_W = Eigen::Quaterniond(start->linear()).normalized();
  }
  if (in_map) return out;
  const PriorMap& map = *mapper.prior_map();
  out.covariance.diagonal().head<3>().array() += map.start_position_sigma_m * map.start_position_sigma_m;
  out.covariance(5, 5) += map.start_heading_sigma_rad * map.start_heading_sigma_rad;
  return out;
}

}  // namespace

std::vector<std::byte> TumblingOdometry::Impl::save() const {
  SavedTumblingState out;
  out.lever_arm_I_m = params_.lever_arm_I_m;
  out.stated_T_IL = stated_calibration_.calibration.T_IL;
  const AngularRateStream& stream = odometry_pass_.rates().rate();
  const AngularRateStream::State& state = odometry_pass_.rate_stream_state().rate;
  const AngularRateStreamParams& used = odometry_pass_.rates().params().rate;
  const bool estimated = whole_recording_result_ ? !whole_recording_result_->report.rate.calibration_at_prior
                                                 : !stream.lever_arm_is_prior(state);
  if (estimated || used.model.calibration) out.rig = body_imu_calibration();
  if (out.rig && !check_body_imu_calibration(*out.rig).ok()) out.rig.reset();
  if (whole_recording_result_ && estimated) out.sensor_errors = whole_recording_result_->report.rate.sensor_errors;
  if (!whole_recording_result_ && (state.sensor_errors.front().accel_delay_state.delay_found || used.calibrated_errors))
    out.sensor_errors = stream.sensor_errors_except_biases(state);
  out.saturation_levels = saturation_levels();
  const auto sigma = mapper().next_lidar_calibration_prior_covariance().diagonal().cwiseSqrt().eval();
  out.lidar = {mapper().lidar_calibration(), sigma.head<3>().maxCoeff(), sigma.segment<3>(3).maxCoeff(), sigma[6]};

  const PriorMap* const prior = mapper().prior_map();
  out.extend = prior == nullptr || prior->extend;
  out.pose = newest_or_start_pose(*this);
  return write_saved_state(out, mapper().check_localised().ok() ? mapper().map() : prior->points);
}

Status TumblingOdometry::Impl::load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose) {
  SavedTumblingState saved;
  PriorMap map;
  const Status read_status =
      read(bytes, params_.lever_arm_I_m, stated_calibration_.calibration.T_IL, saved, map.points);
  if (!read_status.ok()) return read_status;
  const auto changed = std::make_unique<Params>(params_);
  Params& params = *changed;
  AngularRateStreamParams& rate = params.expert->rate.rate;
  if (saved.rig) {
    rate.model.nominal.gyro_bias_rad_s = saved.rig->constants.gyro_bias_rad_s;
    // Sensor biases change each time the sensor is switched on, so their variances are increased.
    auto variance = saved.rig->covariance.diagonal();
    variance.segment<3>(3).array() += rate.model.gyro_bias_sigma_rad_s * rate.model.gyro_bias_sigma_rad_s;
    variance.segment<3>(6).array() += rate.model.accel_bias_sigma_m_s2 * rate.model.accel_bias_sigma_m_s2;
    rate.model.calibration = saved.rig;
  }
  if (saved.sensor_errors) rate.calibrated_errors = std::make_shared<KnownSensorErrors>(*saved.sensor_errors);
  odometry::start_from_saturation_levels(saved.saturation_levels, rate.saturation_detector, rate.expert.gyro_planes,
                                         rate.expert.accel_saturation_planes);
  // The poses of further lidars relative to the first lidar are assumed exact.
  for (FurtherLidar& further : params.further_lidars)
    further.T_IL = saved.lidar.calibration.T_IL * params.T_IL.inverse() * further.T_IL;
  params.T_IL = saved.lidar.calibration.T_IL;
  params.expert->mapping.imu_minus_lidar_clock_s = saved.lidar.calibration.imu_minus_lidar_clock_s;
  params.mount_sigma_rad = saved.lidar.mount_sigma_rad;
  params.mount_sigma_m = saved.lidar.mount_sigma_m;
  params.time_offset_sigma_s = saved.lidar.time_offset_sigma_s;
  if (const Status status = check_odometry_params(odometry::mapper_params(params)); !status.ok()) return status;

  auto fresh = std::make_unique<Impl>(params);
  fresh->stated_calibration_ = stated_calibration_;
  map.extend = saved.extend;
  if (saved.pose) {
    set_prior_pose(*saved.pose, map);
    fresh->odometry_pass_.set_start_pose(*map.start_T_MI);
  }
  if (check_prior_map(map).ok()) (void)fresh->odometry_pass_.set_prior_map(std::move(map));
  *this = std::move(*fresh);
  if (last_pose) *last_pose = saved.pose;
  return {};
}

}  // namespace tumble
