// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "estimator/attitude/broad_trial.hpp"
#include "tumble/attitude/madgwick.hpp"

namespace tumble {
namespace {

TEST(BroadMadgwick, LandsOnTheMeasuredErrorsOfTrial05) {
  const std::string folder = testing::broad_folder();
  if (folder.empty()) GTEST_SKIP() << "no shared data folder at " << TUMBLE_SHARED_DATA;
  const testing::BroadTrial trial = testing::read_broad_trial(folder, "05");
  const Madgwick filter({.gain_rad_s = 0.033});
  Madgwick::State state;
  std::vector<Eigen::Quaterniond> q_WI;
  for (const ImuSample& sample : trial.samples) {
    ASSERT_TRUE(filter.step(sample, state).ok());
    q_WI.push_back(state.q_WI);
  }
  const testing::BroadError error = testing::score(trial, q_WI);
  // measured beforehand with another program: 0.55 / 21.3 / 0.19, printed to these digits
  EXPECT_NEAR(error.inclination_motion_deg, 0.55, 0.05);
  EXPECT_NEAR(error.heading_motion_deg, 21.3, 0.1);
  EXPECT_NEAR(error.inclination_rest_deg, 0.19, 0.05);
}

}  // namespace
}  // namespace tumble
