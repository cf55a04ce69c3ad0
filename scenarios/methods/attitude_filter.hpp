// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

template <typename Filter>
Estimate run_attitude_filter(const sim::Sensors& sensors, const typename Filter::Params& params) {
  const Filter filter(params);
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;

  typename Filter::State state;
  estimate.attitudes.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = filter.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, Eigen::Matrix3d::Zero()});
  }
  return estimate;
}

}  // namespace tumble::scenarios
