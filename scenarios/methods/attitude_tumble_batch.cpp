// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/attitude_tumble.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/report_rates.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/attitude/detail/clipped_readings.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"

namespace tumble::scenarios {

namespace {

void report_carried(const HandHeldSmoother::Report& report, std::map<std::string, double>& health) {
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
}

const Settings<HandHeldSmoother::Params>& carried_settings() {
  static const Settings<HandHeldSmoother::Params> all(HandHeldSmoother::Params{}, {.stated = {"gravity_m_s2"}});
  return all;
}

ClippedReadings find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::map<std::string, double>& health) {
  ClippingFinder::Params params;
  params.axis_limit_params = stated_rails(record);
  const ClippingFinder::ClippingSearchResult found = ClippingFinder(params).find(samples);
  report_rails(found.saturation_levels, health);
  return clipped_readings_of(samples, found);
}

HandHeldSmoother::Params carried_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  HandHeldSmoother::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  carried_settings().apply(parameters, params);
  return params;
}

Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters, std::vector<AngularRateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health) {
  std::vector<ImuSample> samples;
  if (const Status status = bridge::primary_imu_samples(sensors, samples); !status.ok()) return status;
  const HandHeldSmoother::Params params = carried_params(sensors, parameters);
  const ClippedReadings known = find_clipped(sensors.imus.front(), samples, health);
  HandHeldSmoother::Report report;
  const Status status =
      HandHeldSmoother(params).estimate(samples, known.clipped_element_signs(), rates, attitudes, report);
  if (!status.ok()) return status;
  known.mark_partly_saturated(rates);
  report_carried(report, health);
  return status;
}

/// In clipped intervals with hand-held motion, the hand-held smoother gives better rates than the rate smoother.
constexpr double kCarried = 0.5;

Status run_thrown(const sim::Sensors& sensors, const sim::Values& parameters, const std::vector<ImuSample>& samples,
                  const RecoveredRates& recovered, std::vector<AngularRateState>& rates, Estimate& estimate) {
  const std::vector<Eigen::Matrix3d>& covariances = recovered.covariances_rad2_s2;
  ClippedReadings known = find_clipped(sensors.imus.front(), samples, estimate.health);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!covariances[k].isZero(0.0)) known.clip_signs[k].gyro = {};
  }
  SensingAxisClipSigns clipped = known.clipped_element_signs();
  clipped.recovered_covariance_rad2_s2 = covariances;
  HandHeldSmoother::Report report;
  const Status status = HandHeldSmoother(carried_params(sensors, parameters))
                            .estimate(recovered.samples, clipped, rates, estimate.attitudes, report);
  if (status.ok()) report_carried(report, estimate.health);
  return status;
}

std::vector<AngularRateState> rates_of(const RecoveredRates& recovered) {
  std::vector<AngularRateState> out(recovered.sources.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].time_ns = recovered.samples[k].time_ns;
    out[k].w_WI_I_rad_s = recovered.samples[k].angular_velocity_rad_s;
    out[k].covariance_rad2_s2 = recovered.covariances_rad2_s2[k];
    out[k].source = recovered.sources[k];
  }
  return out;
}

Estimate run_attitude_tumble_batch(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  RecoveredRates recovered;
  recovered.samples = samples;
  if (sensors.sphere_radius_m <= 0.0)
    recovered = recovered_readings(sensors, samples, ReadingsToReplace::clipped, estimate);
  std::vector<AngularRateState> rates;
  if (recovered.estimated && recovered.report.hand_held_probability_max < kCarried) {
    estimate.status = run_thrown(sensors, parameters, samples, recovered, rates, estimate);
  } else {
    estimate.status = run_carried(sensors, parameters, rates, estimate.attitudes, estimate.health);
  }
  if (!estimate.status.ok()) return estimate;
  report_unknown_attitude(estimate);
  // The health checks use the input of the attitude smoother, because the output of the smoother always agrees with
  // gravity at rest.
  (void)check_imu(sensors, samples, rates_of(recovered), carried_share(recovered.report), estimate);
  return estimate;
}

}  // namespace

Method attitude_tumble_batch() {
  return make_method({.name = "tumble_batch",
                      .kind = Kind::attitude,
                      .doc = "Smooths the complete recording of a hand-held body. The smoother assumes bounded "
                             "acceleration, velocity and "
                             "position, and uses clipped gyro readings as bounds. While the body moves freely, rates "
                             "come from rate/tumble.",
                      .ours = true,
                      .settings = {&carried_settings()}},
                     at_sample_times<run_attitude_tumble_batch>);
}

}  // namespace tumble::scenarios
