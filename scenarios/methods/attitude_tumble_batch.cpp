// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <vector>

#include "scenarios/methods/attitude_tumble.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/carried.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/recovered_rates.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/report_rates.hpp"
#include "scenarios/methods/sample_times.hpp"

namespace tumble::scenarios {

namespace {

/// The hand-held smoother replaces the rate smoother if the probability of hand-held motion in clipped intervals
/// exceeds kCarried. During hand-held motion, the motion limits of the hand-held smoother give better rates than the
/// rate smoother.
constexpr double kCarried = 0.5;

/// Smooths the attitude with the recovered rates as gyro readings, for a body that was not hand-held while its gyro
/// clipped. The vector `rates` is the output of the rate smoother.
Status run_thrown(const sim::Sensors& sensors, const sim::Values& parameters, const std::vector<ImuSample>& samples,
                  const RecoveredRates& recovered, std::vector<RateState>& rates, Estimate& estimate) {
  const std::vector<Eigen::Matrix3d>& covariances = recovered.covariances_rad2_s2;
  ClippedReadings known = find_clipped(sensors.imus.front(), samples, estimate.health);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!covariances[k].isZero(0.0)) known.signs[k].gyro = {};
  }
  ClippedElements clipped = known.clipped();
  clipped.recovered_covariance_rad2_s2 = covariances;
  HandHeldSmoother::Report report;
  const Status status = HandHeldSmoother(carried_params(sensors, parameters))
                            .estimate(recovered.samples, clipped, rates, estimate.attitudes, report);
  if (status.ok()) report_carried(report, estimate.health);
  return status;
}

std::vector<RateState> rates_of(const RecoveredRates& recovered) {
  std::vector<RateState> out(recovered.sources.size());
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
    recovered = recovered_readings(sensors, samples, ReplacedReadings::clipped, estimate);
  std::vector<RateState> rates;
  if (recovered.estimated && recovered.report.hand_held_probability_max < kCarried) {
    estimate.status = run_thrown(sensors, parameters, samples, recovered, rates, estimate);
  } else {
    estimate.status = run_carried(sensors, parameters, rates, estimate.attitudes, estimate.health);
  }
  if (!estimate.status.ok()) return estimate;
  report_unknown_attitude(estimate);
  // The checks use the input of the attitude smoother, because its output always agrees with gravity at rest.
  (void)check_imu(sensors, samples, rates_of(recovered), carried_share(recovered.report), estimate);
  return estimate;
}

}  // namespace

Method attitude_tumble_batch() {
  MethodInfo info;
  info.name = "tumble_batch";
  info.kind = Kind::attitude;
  info.doc =
      "Smooths the complete recording of a hand-held body. The smoother assumes bounded acceleration, velocity and "
      "position, and uses clipped gyro readings as bounds. While the body moves freely, rates come from rate/tumble.";
  info.ours = true;
  info.settings = {&carried_settings()};
  return make_method(std::move(info), at_sample_times<run_attitude_tumble_batch>);
}

}  // namespace tumble::scenarios
