// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"

namespace tumble::scenarios {
namespace {

sim::Values defaults() {
  return sim::resolve("method.rate/tumble", {}, tumble_rate_parameters());
}

TEST(RateLearnt, WhatARunLearnsIsTheStartOfTheNext) {
  const sim::Recording recording = testing::synthetic_rig();
  LearntRig first, second;
  const Estimate one = run_rate_tumble(recording.sensors, defaults(), nullptr, &first);
  const Estimate two = run_rate_tumble(recording.sensors, defaults(), &first, &second);
  ASSERT_TRUE(one.status.ok());
  ASSERT_TRUE(two.status.ok());
  // the same readings again, from four times the covariance of the first run: they add what they said the first time
  for (int j = 0; j < 3; ++j) {
    EXPECT_LT(second.calibration.covariance(j, j), 1.01 * first.calibration.covariance(j, j)) << j;
    EXPECT_GT(second.calibration.covariance(j, j), 0.1 * first.calibration.covariance(j, j)) << j;
  }
  ASSERT_EQ(two.rates.size(), one.rates.size());
}

TEST(RateLearnt, WithoutAStartItIsTheMethodOfTheRegistry) {
  const sim::Recording recording = testing::synthetic_rig();
  const Estimate registered = find_methods("rate/tumble").front()->run(recording.sensors, {}, {});
  const Estimate here = run_rate_tumble(recording.sensors, defaults(), nullptr, nullptr);
  ASSERT_EQ(here.rates.size(), registered.rates.size());
  ASSERT_GT(here.rates.size(), 0u);
  for (std::size_t k = 0; k < here.rates.size(); ++k) {
    ASSERT_EQ(here.rates[k].w_WI_I_rad_s, registered.rates[k].w_WI_I_rad_s) << k;
  }
}

TEST(RateLearnt, AFailedRunLeavesWhatWasLearnt) {
  sim::Recording recording = testing::synthetic_rig();
  recording.sensors.imus.front().gyro_rad_s.front().x() = std::numeric_limits<double>::quiet_NaN();
  LearntRig rig;
  rig.calibration.constants.lever_arm_m = {1.0, 2.0, 3.0};
  EXPECT_FALSE(run_rate_tumble(recording.sensors, defaults(), nullptr, &rig).status.ok());
  EXPECT_EQ(rig.calibration.constants.lever_arm_m, Eigen::Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace tumble::scenarios
