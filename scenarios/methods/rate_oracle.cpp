// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"

namespace tumble::scenarios {

namespace {

Estimate run_rate_oracle(const sim::Sensors& sensors, const sim::Values&, const OracleInput& oracle) {
  Estimate estimate;
  estimate.status = unclipped_rates(sensors, *oracle.truth, estimate.rates);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<AngularRateState>& out) {
  out.clear();
  // If the clipped readings are invalid, every other method fails, so this oracle must fail too.
  std::vector<ImuSample> samples;
  Status status = bridge::primary_imu_samples(sensors, samples);
  if (!status.ok()) return status;
  if (truth.imus.empty())
    throw BadInput("the truth contains no IMU, but this method needs the unclipped readings of an IMU");
  status = bridge::unclipped_samples(sensors.imus.front(), truth.imus.front(), samples);
  if (!status.ok()) return status;
  return raw_rates(sensors, samples, out);
}

Method rate_oracle() {
  MethodInfo info;
  info.name = "oracle";
  info.kind = Kind::rate;
  info.doc =
      "Gives an upper bound of the accuracy: returns the readings of the same gyro without saturation. Noise, bias and "
      "bandwidth are unchanged.";
  info.ours = true;
  info.needs_truth = true;
  return make_method(std::move(info), at_sample_times<run_rate_oracle>);
}

}  // namespace tumble::scenarios
