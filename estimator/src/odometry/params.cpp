// SPDX-License-Identifier: BSD-3-Clause
#include "tumbling_odometry_impl.hpp"

#include <algorithm>

#include "rolling_odometry_impl.hpp"
#include "saved_bytes.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

namespace {

// standard deviation of gravity's horizontal components after levelling
constexpr double kGravitySigma_m_s2 = 0.03;

constexpr std::size_t kRecoveringUnits = 3;  // minimum number of IMUs for recovering a rate beyond the gyro range
constexpr double kRecoveredSigma_rad_s = 1.0;
// prior standard deviations for an IMU without a data sheet, at an unknown position in the sphere
constexpr double kUnknownGyroBias_rad_s = 5e-3, kUnknownAccelBias_m_s2 = 0.4, kUnknownScale = 0.01,
                 kUnknownDelay_s = 5e-3, kUnknownLeverArm_m = 0.05;
// maximum number of stored readings per sensor, sufficient for some seconds of motion near the largest rate or force
constexpr std::size_t kClippingReadings = 512;
constexpr double kLevelInclinePerS = 1e-9;  // rate of transitions to a slope, for a floor that is known to be level

// The radius has no default.
void require_stated_params(RollingOdometry::Params params) {
  params.expert->rolling.filter.radius_m = params.radius_m;
  require_valid_fields(params);
}

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

std::span<const char* const> RollingOdometry::Params::computed_parameter_names() {
  static constexpr const char* kNames[] = {
      "rolling_radius_m",         "rolling_gravity_m_s2",     "rolling_lever_arm_m", "rolling_lever_arm_sigma_m",
      "rolling_gyro_range_rad_s", "rolling_accel_range_m_s2", "rolling_lag_s"};
  return kNames;
}

void RollingOdometry::Params::widen_priors_for_unknown_imus() {
  const auto widen = [](double& sigma, double least) { sigma = std::max(sigma, least); };
  RollingParams& filter = expert->rolling.filter;
  widen(filter.expert.prior.gyro_bias_sigma_rad_s, kUnknownGyroBias_rad_s);
  widen(filter.expert.prior.accel_bias_sigma_m_s2, kUnknownAccelBias_m_s2);
  widen(filter.expert.prior.tilt_sigma_rad, kUnknownAccelBias_m_s2 / gravity_m_s2);
  widen(filter.expert.prior.accel_scale_sigma, kUnknownScale);
  widen(filter.expert.prior.gyro_scale_sigma, kUnknownScale);
  widen(filter.expert.prior.accel_delay_sigma_s, kUnknownDelay_s);
  widen(centre_sigma_m, kUnknownLeverArm_m);
  double& inclines = filter.expert.modes.incline_begins_per_s;
  inclines = std::min(inclines, kLevelInclinePerS);
}

namespace odometry {

ImuMerge::Setup merge_setup(const RollingOdometry::Params& params) {
  require_stated_params(params);
  require_in_interval("units", static_cast<double>(params.imus.size()), 1.0, ImuMerge::kImus);
  ImuMerge::Setup out;
  out.count = static_cast<int>(params.imus.size());
  for (std::size_t k = 0; k < params.imus.size(); ++k) {
    const RollingOdometry::ImuSetup& unit = params.imus[k];
    require_valid_fields(unit.data_sheet);
    require_in_interval("T_BI translation", unit.T_BI.translation().norm(), 0.0, params.radius_m);
    out.T_mean_imu[k] = unit.T_BI;
    const ImuDataSheet& sheet = unit.data_sheet;
    out.gyro_range_rad_s = std::min(out.gyro_range_rad_s, max_unsaturated_reading(sheet.gyro_range_rad_s));
    out.accel_range_m_s2 = std::min(out.accel_range_m_s2, max_unsaturated_reading(sheet.accel_range_m_s2));
  }
  return out;
}

RollingSmoother::Params rolling_params(const RollingOdometry::Params& params, const ImuMerge::Setup& merged,
                                       std::size_t units, const Eigen::Vector3d& lever_arm_m) {
  RollingSmoother::Params out = params.expert->rolling;
  out.filter.radius_m = params.radius_m;
  out.filter.gravity_m_s2 = params.gravity_m_s2;
  out.filter.lever_arm_m = lever_arm_m;
  out.filter.lever_arm_sigma_m = params.centre_sigma_m;
  out.filter.gyro_range_rad_s = merged.gyro_range_rad_s;
  out.filter.accel_range_m_s2 = merged.accel_range_m_s2;
  if (units >= kRecoveringUnits) out.filter.expert.saturation.recovered_rate_sigma_rad_s = kRecoveredSigma_rad_s;
  out.lag_s = std::max(params.lag_s, out.filter.expert.kNode_s);
  out.rate_max_hz = std::max(out.rate_max_hz, 1.1 * params.imus.front().data_sheet.rate_hz);
  return out;
}

std::vector<StreamingClippingFinder> clipping_finders_of(const RollingOdometry::Params& params,
                                                         std::span<const SaturationLevels> known) {
  std::vector<StreamingClippingFinder> out;
  for (std::size_t k = 0; k < params.imus.size(); ++k) {
    ClippingFinder::Params clipping = clipping_finder_params(params.imus[k].data_sheet);
    if (!known.empty())
      start_from_saturation_levels(known[k], clipping.axis_limit_params, clipping.gyro_planes,
                                   clipping.accel_saturation_planes);
    out.emplace_back(clipping, kClippingReadings);
  }
  return out;
}

std::vector<FrozenAxes> frozen_axis_detectors(const RollingOdometry::Params& params) {
  std::vector<FrozenAxes> out;
  for (const RollingOdometry::ImuSetup& unit : params.imus) {
    out.emplace_back(FrozenAxes::ImuRanges{.gyro_range_rad_s = unit.data_sheet.gyro_range_rad_s,
                                           .accel_range_m_s2 = unit.data_sheet.accel_range_m_s2});
  }
  return out;
}

std::vector<OutlierFilter> outlier_filters_of(const RollingOdometry::Params& params) {
  std::vector<OutlierFilter> out;
  for (const RollingOdometry::ImuSetup& unit : params.imus) {
    out.emplace_back(OutlierFilter::ImuRanges{.gyro_range_rad_s = unit.data_sheet.gyro_range_rad_s,
                                              .accel_range_m_s2 = unit.data_sheet.accel_range_m_s2,
                                              .period_s = 1.0 / unit.data_sheet.rate_hz});
  }
  return out;
}

}  // namespace odometry

}  // namespace tumble
