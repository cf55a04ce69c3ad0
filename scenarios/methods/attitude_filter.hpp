// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/method.hpp"

/// What the attitude methods have in common: a filter of the estimator fed with the primary IMU, sample by sample.
namespace tumble::scenarios {

/// No covariance: for filters that report none.
struct NoCovariance {
  template <typename State>
  Eigen::Matrix3d operator()(const State&) const {
    return Eigen::Matrix3d::Zero();
  }
};

/// One attitude per sample of the primary IMU, in its frame. `Filter` has Params, State with q_WI, and step(sample,
/// state). `covariance(state)` gives that of AttitudeState. The first trouble ends the run; the attitudes before it
/// stay.
template <typename Filter, typename CovarianceOf = NoCovariance>
Estimate run_attitude_filter(const sim::Sensors& sensors, const typename Filter::Params& params,
                             const CovarianceOf& covariance = {}) {
  const Filter filter(params);
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;

  (void)check_imu(sensors, samples, estimate);  // a warning: a body that is pushed about all the time may look so
  typename Filter::State state;
  estimate.attitudes.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = filter.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, covariance(state)});
  }
  return estimate;
}

}  // namespace tumble::scenarios
