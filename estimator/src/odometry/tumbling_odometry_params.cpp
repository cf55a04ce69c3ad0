// SPDX-License-Identifier: BSD-3-Clause
#include "tumbling_odometry_params.hpp"

#include <algorithm>

namespace tumble {

namespace {

// standard deviation of gravity's horizontal components after levelling
constexpr double kGravitySigma_m_s2 = 0.03;

}  // namespace

std::span<const char* const> TumblingExpertParams::computed_parameter_names() {
  static constexpr const char* kNames[] = {"rate_lever_arm_sigma_m",
                                           "rate_gyro_noise_density",
                                           "rate_accel_noise_density",
                                           "rate_period_s",
                                           "rate_lag_s",
                                           "rate_evidence_gravity_m_s2",
                                           "rate_carried_gravity_m_s2",
                                           "rate_carried_gap_max_s",
                                           "rate_carried_period_s",
                                           "rate_carried_lag_s",
                                           "rate_carried_iterations_max",
                                           "mapping_mount_sigma_*",
                                           "mapping_time_offset_sigma_s",
                                           "mapping_gravity_m_s2",
                                           "mapping_range_*",
                                           "mapping_own_body_*",
                                           "mapping_accel_rail_m_s2"};
  return kNames;
}

MotionRegimeStream::Params TumblingExpertParams::default_rate_params() {
  MotionRegimeStream::Params out;
  out.rate.expert.uncalibrated = 0.003;
  return out;
}

OdometryParams TumblingExpertParams::default_mapping_params() {
  LidarInertialOdometry::Params out;
  out.expert.gravity_sigma_m_s2 = kGravitySigma_m_s2;
  out.expert.saturated_imu.estimate_deficit = true;
  return out;
}

namespace odometry {

MotionRegimeStream::Params rate_stream_params(const TumblingOdometry::Params& params) {
  require_valid_fields(params);
  MotionRegimeStream::Params out = params.expert->rate;
  AngularRateModelParams& model = out.rate.model;
  model.nominal.lever_arm_m = params.lever_arm_I_m;
  model.lever_arm_sigma_m = params.lever_arm_sigma_m;
  model.gyro_noise_density = params.imu.gyro_noise_rad_s_sqrt_hz;
  model.accel_noise_density = params.imu.accel_noise_m_s2_sqrt_hz;
  if (params.imu.gyro_range_rad_s > 0.0)
    out.rate.saturation_detector.stated_gyro_range_rad_s = params.imu.gyro_range_rad_s;
  if (params.imu.accel_range_m_s2 > 0.0)
    out.rate.saturation_detector.stated_accel_range_m_s2 = params.imu.accel_range_m_s2;
  out.rate.period_s = 1.0 / params.imu.rate_hz;
  const bool whole = params.lag_s >= TumblingOdometry::kWholeRecording;  // rates_ is unused for a whole recording
  out.rate.lag_s = std::max(whole ? TumblingParams{}.lag_s : params.lag_s, 2.0 * out.rate.period_s);
  out.evidence.gravity_m_s2 = out.hand_held.body.gravity_m_s2 = params.expert->gravity_m_s2;
  out.hand_held.body.expert.gap_max_s = out.rate.kGapMax_s;
  return out;
}

OutlierFilter::ImuRanges outlier_params(const TumblingOdometry::Params& params) {
  return {.gyro_range_rad_s = params.imu.gyro_range_rad_s,
          .accel_range_m_s2 = params.imu.accel_range_m_s2,
          .period_s = 1.0 / params.imu.rate_hz,
          .gap_max_s = params.expert->rate.rate.kGapMax_s};
}

LidarInertialOdometry::Params mapper_params(const TumblingOdometry::Params& params) {
  LidarInertialOdometry::Params out = params.expert->mapping;
  out.T_IL = params.T_IL;
  out.mount_sigma_rad = params.mount_sigma_rad;
  out.mount_sigma_m = params.mount_sigma_m;
  out.time_offset_sigma_s = params.time_offset_sigma_s;
  out.expert.gravity_m_s2 = params.expert->gravity_m_s2;
  out.range_min_m = params.lidar.range_min_m;
  out.range_max_m = params.lidar.range_max_m;
  out.own_body_L = params.own_body_L;
  if (params.imu.accel_range_m_s2 > 0.0)
    out.expert.saturated_imu.accel_m_s2 = max_unsaturated_reading(params.imu.accel_range_m_s2);
  return out;
}

MotionRegimeSmoother::Params recording_rate_params(const TumblingOdometry::Params& params) {
  const MotionRegimeStream::Params stream = rate_stream_params(params);
  const AngularRateModelParams whole;
  MotionRegimeSmoother::Params out;
  out.rate.model = stream.rate.model;
  out.rate.model.accel_bias_sigma_m_s2 = whole.accel_bias_sigma_m_s2;
  out.rate.model.inertia_sigma = whole.inertia_sigma;
  out.rate.saturation_detector = stream.rate.saturation_detector;
  out.rate.calibration_mahalanobis_max = stream.rate.calibration_mahalanobis_max;
  if (stream.rate.calibrated_errors) out.rate.calibrated_errors = *stream.rate.calibrated_errors;
  out.rate.expert.gyro_planes = stream.rate.expert.gyro_planes;
  out.rate.expert.accel_saturation_planes = stream.rate.expert.accel_saturation_planes;
  out.rate.expert.rest_detector = stream.rate.expert.rest_detector;
  static_cast<MotionRegimeParams&>(out) = stream;
  out.hand_held = stream.hand_held.body;
  return out;
}

}  // namespace odometry

}  // namespace tumble
