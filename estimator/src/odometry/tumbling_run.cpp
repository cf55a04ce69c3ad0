// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "saved_bytes.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"
#include "tumbling_odometry_impl.hpp"

namespace tumble {

namespace {

ImuDescription imu_check_params(const TumblingOdometry::Params& params) {
  return {.gyro_range_rad_s = params.imu.gyro_range_rad_s,
          .accel_range_m_s2 = params.imu.accel_range_m_s2,
          .gravity_m_s2 = params.expert->gravity_m_s2,
          .lever_arm_I_m = params.lever_arm_I_m};
}

/// `stamps_ns` receives the uncorrected time stamps of all samples that OutlierFilter accepts.
Status select_samples(const OutlierFilter& filter, const SampleClock& clock, std::vector<ImuSample>& samples,
                      OutlierFilter::State& outliers, WholeRecordingEstimate& out) {
  const std::vector<bool> inlier = find_inliers(filter, samples);
  std::size_t next = 0;
  outliers.rejected += std::erase_if(samples, [&](const ImuSample&) { return !inlier[next++]; });
  for (const ImuSample& sample : samples) out.stamps_ns.push_back(sample.time_ns);
  std::vector<TimeNs> times_ns = out.stamps_ns;
  if (Status status = correct_stamps(clock, times_ns, out.corrected_jitter_s); !status.ok()) return status;
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].time_ns = times_ns[k];
  return {};
}

Status estimate_rates(const TumblingOdometry::Params& params, std::span<const ImuSample> samples,
                      WholeRecordingEstimate& out) {
  const MotionRegimeSmoother smoother(odometry::recording_rate_params(params));
  if (Status status = smoother.estimate(samples, out.rates, out.report); !status.ok()) return status;
  const std::optional<double> hand_held =
      out.report.regimes_estimated ? std::optional(out.report.probabilities.hand_held) : std::nullopt;
  out.findings = check_recording(imu_check_params(params), samples, out.rates, hand_held);
  out.suspected_error_covariance_rad2_s2 = suspected_error_covariance(out.findings, samples, out.rates);
  for (std::size_t k = 0; k < out.suspected_error_covariance_rad2_s2.size(); ++k)
    out.rates[k].covariance_rad2_s2 += out.suspected_error_covariance_rad2_s2[k];
  return {};
}

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

Status TumblingOdometry::Impl::record_sample(const ImuSample& sample) {
  if (finished_) return {ErrorCode::out_of_range, "samples after finish()", 1.0, 0.0};
  StampOrder::Verdict verdict{};
  if (const Status status = stamp_order_.order_of_stamp(sample.time_ns, stamp_order_state_, verdict); !status.ok())
    return status;
  const bool first_is_wrong = verdict != StampOrder::Verdict::continues_in_order && recorded_samples_.size() <= 1;
  if (verdict == StampOrder::Verdict::restarts_after_step_back && !first_is_wrong)
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(recorded_samples_.back().time_ns)};
  if (verdict == StampOrder::Verdict::restarts_after_gap && !first_is_wrong) ++restart_count_;
  if (first_is_wrong) {
    recorded_samples_.clear();
    stamp_order_state_ = {};
    last_registered_ns_.reset();
  }
  StampOrder::accept(sample.time_ns, stamp_order_state_);
  recorded_samples_.push_back(sample);
  newest_ns_ = sample.time_ns;
  if (!last_registered_ns_) last_registered_ns_ = sample.time_ns;
  return {};
}

Status TumblingOdometry::Impl::finish_whole_recording(const SweepProgress& on_sweep) {
  if (finished_) return {};
  finished_ = true;
  finished_results_.clear();
  const LidarInertialOdometry::Params mapping = odometry::mapper_params(params_);
  const auto whole = std::make_shared<WholeRecordingEstimate>(mapping);
  std::vector<ImuSample> samples = recorded_samples_;
  if (Status status = select_samples(outlier_filter_, sample_clock_, samples, outlier_filter_state_, *whole);
      !status.ok())
    return status;
  if (Status status = estimate_rates(params_, samples, *whole); !status.ok()) return status;
  whole->saturation_levels =
      flag_saturated_forces(odometry::recording_rate_params(params_).rate.saturation_detector, samples);
  for (WaitingSweep& sweep : waiting_sweeps_) further_lidars_.merge_into(sweep);
  if (!waiting_sweeps_.empty()) {
    const MappingInput input{samples,
                             whole->rates,
                             waiting_sweeps_.size(),
                             [&](std::size_t k) {
                               if (on_sweep) on_sweep(k, waiting_sweeps_.size());
                               return waiting_sweeps_[k];
                             },
                             [this](TimeNs from_ns, TimeNs to_ns) { return readings_.find(from_ns, to_ns); },
                             odometry_pass_.mapper().start_pose()};
    whole->mapped_recording = map_with_calibration(input, mapping);
    whole->scale = find_sweep_scale(samples, whole->mapped_recording, params_.expert->gravity_m_s2);
  }
  PositionAlignment positions = positions_;
  for (MappedSweep& sweep : whole->mapped_recording.sweeps) {
    positions.add_sweep(sweep.result);
    finished_results_.push_back({sweep.status, std::move(sweep.result), positions.position_frame()});
  }
  whole->mapped_recording.sweeps.clear();
  whole->health = whole->findings.health;
  if (!waiting_sweeps_.empty()) whole->mapped_recording.add_findings(whole->scale, whole->health);
  whole_recording_result_ = whole;
  return whole->mapped_recording.status;
}

const LidarInertialOdometry& TumblingOdometry::Impl::mapper() const {
  return whole_recording_result_ ? whole_recording_result_->mapped_recording.mapper : odometry_pass_.mapper();
}

const LidarScale& TumblingOdometry::lidar_scale() const {
  return impl_->whole_recording_result_ ? impl_->whole_recording_result_->scale : impl_->odometry_pass_.lidar_scale();
}

BodyImuCalibration TumblingOdometry::Impl::body_imu_calibration() const {
  return whole_recording_result_
             ? whole_recording_result_->report.rate.calibration
             : odometry_pass_.rates().rate().body_imu_calibration(odometry_pass_.rate_stream_state().rate);
}

const SaturationLevels& TumblingOdometry::Impl::saturation_levels() const {
  return whole_recording_result_ ? whole_recording_result_->saturation_levels
                                 : odometry_pass_.rate_stream_state().rate.clipping_state.known_limits;
}

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
