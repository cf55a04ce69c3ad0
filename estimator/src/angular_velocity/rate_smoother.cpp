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

Status check_auxiliary_imus(const RateModelParams& params,
                            std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, std::size_t count) {
  const auto needed = static_cast<double>(params.auxiliary_imus.size());
  if (auxiliary_imus.size() != params.auxiliary_imus.size()) {
    return {ErrorCode::too_few, "auxiliary_imus", static_cast<double>(auxiliary_imus.size()), needed};
  }
  for (const std::vector<AuxiliaryReading>& readings : auxiliary_imus) {
    if (readings.size() == count) continue;
    return {ErrorCode::too_few, "readings of an auxiliary_imu", static_cast<double>(readings.size()),
            static_cast<double>(count)};
  }
  return {};
}

/// A large zero offset of the gyro becomes the nominal bias, unless the user states a bias.
RateSmootherParams with_offset(const RateSmootherParams& params, std::span<const ImuSample> samples) {
  RateSmootherParams out = params;
  Eigen::Vector3d& nominal = out.model.nominal.gyro_bias_rad_s;
  if (nominal.isZero(0.0) && !out.model.calibration) nominal = GyroOffset().find(samples);
  return out;
}

}  // namespace

RateSmoother::RateSmoother(const Params& params)
    : params_(params),
      rails_({params.rails, params.expert.planes, params.expert.accel_planes}),
      rest_detector_(params.expert.rests) {
  require_valid_fields(params);
  if (params.calibrated_errors) require_known(*params.calibrated_errors);
  (void)RateModel(params.model, 0.01);  // throws for invalid parameters
}

Status RateSmoother::estimate(std::span<const ImuSample> samples,
                              std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                              std::vector<RateState>& out, RateReport& report) const {
  if (Status status = check_recording(samples, 2, std::numeric_limits<double>::infinity()); !status.ok()) return status;
  if (Status status = check_auxiliary_imus(params_.model, auxiliary_imus, samples.size()); !status.ok()) return status;

  RateReport health;
  const ClippingFinder::Found found = rails_.find(samples);
  const Params params = with_offset(params_, samples);
  const std::vector<bool> rests = rest_detector_.find(samples, params.model.nominal.gyro_bias_rad_s);
  RateReadings readings = read_samples(params, rails_, found, rests, samples, auxiliary_imus, health);
  RateFit fit(readings.observations, RateModel(readings.known, median_period_s(samples)));
  if (Status status = fit_rounds(params, readings.known, samples, found.clippings, readings.observations, fit, health);
      !status.ok()) {
    return status;
  }
  out = rate_states(params, samples, readings, fit, health);
  report = std::move(health);
  return {};
}

}  // namespace tumble
