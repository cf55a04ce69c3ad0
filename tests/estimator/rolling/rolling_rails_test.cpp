// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/src/rolling/rolling_node.hpp"
#include "tests/testing.hpp"

// rolling.md (R7), (R8): forces with some saturated accelerometer axes.
namespace tumble::rolling {
namespace {

constexpr double kRepeated_s = 4e-3, kRail_m_s2 = 80.0;

struct Gained {
  Eigen::Vector3d velocity_m_s, hidden_m_s;
};

/// Returns the result of one reading of a sphere at rest in W, at a constant rate.
Gained gained(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2, std::uint8_t flags,
              Force known = Force::force_measured) {
  RollingParams params;
  params.accel_range_m_s2 = kRail_m_s2;
  params.lever_arm_m = {0.1, 0.0, 0.0};
  params.expert.saturation.recovered_rate_sigma_rad_s = 0.1;
  RollingNominalState nominal;
  nominal.last_rate_I_rad_s = rate_rad_s;
  RollingNodeIntegrals sums;
  integrate(params, {0, rate_rad_s, force_m_s2, flags}, kRepeated_s, nominal, sums, known);
  EXPECT_DOUBLE_EQ(sums.force_clipped_s, flags != 0 || known == Force::force_unknown ? kRepeated_s : 0.0);
  return {nominal.v_WI_m_s, sums.partial_saturation_W_m_s};
}

// An impact that saturates a part of the window is at least the reading, as without the flag; without the correction,
// its velocity was zero within 16 mm/s.
TEST(RollingSaturation, AnImpactIsAtLeastWhatWasRead) {
  const Eigen::Vector3d read(-3.0, 17.0, 57.0);
  const double gravity = RollingParams{}.gravity_m_s2;
  const Eigen::Vector3d expected = kRepeated_s * (read - gravity * Eigen::Vector3d::UnitZ());
  const Gained railed = gained(Eigen::Vector3d::Zero(), read, kClipAccel);
  EXPECT_LT((railed.velocity_m_s - expected).norm(), 1e-12);
  const double share = RollingParams{}.expert.saturation.subsample_saturation_ratio;
  EXPECT_NEAR(railed.hidden_m_s.z(), share * kRepeated_s * 57.0, 1e-12) << "and how much more is not known";
  EXPECT_LT((gained(Eigen::Vector3d::Zero(), read, 0).velocity_m_s - expected).norm(), 1e-12);
  // negative control: a missing force contributes nothing
  EXPECT_LT(gained(Eigen::Vector3d::Zero(), read, kClipAccel, Force::force_unknown).velocity_m_s.norm(), 1e-12);
}

// A fast rotation about z saturates x: 160 m/s^2 keep the centre where it is, without an impact. The other axes keep
// their readings.
TEST(RollingSaturation, AFastTurnIsWhatItTakesToKeepTheCentre) {
  constexpr double kRate_rad_s = 40.0;
  const double gravity = RollingParams{}.gravity_m_s2;
  const Eigen::Vector3d read(-kRail_m_s2, 0.0, gravity);
  const Gained turning = gained({0.0, 0.0, kRate_rad_s}, read, kClipAccelX);
  EXPECT_NEAR(turning.velocity_m_s.norm(), kRepeated_s * kRate_rad_s * kRate_rad_s * 0.1, 0.01);
  EXPECT_NEAR(turning.velocity_m_s.z(), 0.0, 1e-12);
  EXPECT_LT(turning.hidden_m_s.norm(), 1e-12);
  // negative control: with the opposite sign it is an impact
  const Gained struck = gained({0.0, 0.0, kRate_rad_s}, -read, kClipAccelX);
  EXPECT_GT(struck.hidden_m_s.norm(), 0.05);
}

// A force that is ignored has no bias that changes the velocity.
TEST(RollingSaturation, AnIgnoredForceHasNoBias) {
  const Eigen::Vector3d rate(0.0, 0.0, 5.0), force(0.0, 0.0, 9.8);
  const auto by_bias = [&](std::uint8_t flags) {
    RollingNominalState nominal;
    RollingNodeIntegrals sums;
    integrate(RollingParams{}, {0, rate, force, flags}, kRepeated_s, nominal, sums);
    return Eigen::Matrix3d(transition(sums).block<3, 3>(kVelocity, kAccelBias));
  };
  EXPECT_TRUE(by_bias(kClipGyroX).isZero(0.0));
  EXPECT_NEAR(by_bias(0).norm(), std::sqrt(3.0) * kRepeated_s, 1e-12);  // negative control
}

}  // namespace
}  // namespace tumble::rolling
