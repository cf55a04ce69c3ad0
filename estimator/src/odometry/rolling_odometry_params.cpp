// SPDX-License-Identifier: BSD-3-Clause
#include "rolling_odometry_params.hpp"

#include <algorithm>

#include "saved_saturation_levels.hpp"
#include "tumble/odometry/detail/merge_recordings.hpp"

namespace tumble {

namespace {

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
    out.emplace_back(StreamingClippingFinder::Params{clipping}, kClippingReadings);
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
