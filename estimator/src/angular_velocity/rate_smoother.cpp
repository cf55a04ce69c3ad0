// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

#include <limits>
#include <utility>

#include "gyro_offset.hpp"
#include "rate_readings.hpp"
#include "rate_rounds.hpp"
#include "rate_states.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"

namespace tumble {

namespace {

Status check_auxiliary_imus(const AngularRateModelParams& params,
                            std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, std::size_t count) {
  const auto needed = static_cast<double>(params.auxiliary_imus.size());
  if (auxiliary_imus.size() != params.auxiliary_imus.size()) {
    return {ErrorCode::insufficient_data, "auxiliary_imus", static_cast<double>(auxiliary_imus.size()), needed};
  }
  for (const std::vector<AuxiliaryReading>& readings : auxiliary_imus) {
    if (readings.size() == count) continue;
    return {ErrorCode::insufficient_data, "readings of an auxiliary_imu", static_cast<double>(readings.size()),
            static_cast<double>(count)};
  }
  return {};
}

/// A large zero offset of the gyro becomes the nominal bias, unless the user states a bias.
AngularRateSmootherParams with_gyro_offset(const AngularRateSmootherParams& params,
                                           std::span<const ImuSample> samples) {
  AngularRateSmootherParams out = params;
  Eigen::Vector3d& nominal = out.model.nominal.gyro_bias_rad_s;
  if (nominal.isZero(0.0) && !out.model.calibration) nominal = GyroOffset().find(samples);
  return out;
}

}  // namespace

AngularRateSmoother::AngularRateSmoother(const Params& params)
    : params_(params),
      clipping_finder_({params.saturation_detector, params.expert.gyro_planes, params.expert.accel_saturation_planes}),
      rest_detector_(params.expert.rest_detector) {
  require_valid_fields(params);
  if (params.calibrated_errors) require_valid_known_errors(*params.calibrated_errors);
  (void)AngularRateModel(params.model, 0.01);  // throws for invalid parameters
}

Status AngularRateSmoother::estimate(std::span<const ImuSample> samples,
                                     std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                                     std::vector<AngularRateState>& out, AngularRateReport& report) const {
  if (Status status = check_recording(samples, 2, std::numeric_limits<double>::infinity()); !status.ok()) return status;
  if (Status status = check_auxiliary_imus(params_.model, auxiliary_imus, samples.size()); !status.ok()) return status;

  AngularRateReport health;
  const ClippingFinder::ClippingSearchResult found = clipping_finder_.find(samples);
  const Params params = with_gyro_offset(params_, samples);
  const std::vector<bool> rests = rest_detector_.find(samples, params.model.nominal.gyro_bias_rad_s);
  AngularRateReadings readings = read_samples(params, clipping_finder_, found, rests, samples, auxiliary_imus, health);
  AngularRateFit fit(readings.observations, AngularRateModel(readings.known_params, median_period_s(samples)));
  if (Status status = fit_rounds(params, readings.known_params, samples, found.clipping_per_sample,
                                 readings.observations, fit, health);
      !status.ok()) {
    return status;
  }
  out = rate_states_of_recording(params, samples, readings, fit, health);
  report = std::move(health);
  return {};
}

}  // namespace tumble
