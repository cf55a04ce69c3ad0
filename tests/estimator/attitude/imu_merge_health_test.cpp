// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/attitude/filter_contract.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/types.hpp"

// IMUs that freeze, fail or disagree are excluded and reported, and no others
namespace tumble {
namespace {

using testing::kGravity_m_s2;

constexpr int kCount = 3, kSeconds = 6;
const std::array<Eigen::Vector3d, kCount> kPositions = {
    {{0.08, 0.0, 0.01}, {-0.04, 0.069, 0.01}, {-0.04, -0.069, 0.01}}};
using UnitReadings = std::array<ImuSample, kCount>;

ImuMerge::Setup unit_params() {
  ImuMerge::Setup out;
  out.count = kCount;
  for (std::size_t k = 0; k < kCount; ++k) {
    out.T_mean_imu[k] = Eigen::Isometry3d::Identity();
    out.T_mean_imu[k].translation() = kPositions[k];
  }
  out.gyro_range_rad_s = 34.0;
  out.accel_range_m_s2 = 76.0;
  return out;
}

double quantised(double value, double quantum) {
  return quantum * std::round(value / quantum);
}

/// The body rests for a second, then turns about a level axis at about 5 rad/s, with the noise and quantisation of a
/// Phidget. `harm(k, readings)` modifies the readings before the merge.
struct HarmedMerge {
  ImuMerge::State state;
  double worst_rate_rad_s = 0.0, worst_force_m_s2 = 0.0;
};
HarmedMerge merge_harmed(int rate_hz, double top_rad_s, double noise,
                         const std::function<void(double, UnitReadings&)>& harm) {
  const ImuMerge merge(unit_params());
  HarmedMerge out;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d axis = Eigen::Vector3d(0.2, 0.95, -0.24).normalized();
  const double dt = 1.0 / rate_hz, wide = noise * std::sqrt(static_cast<double>(rate_hz));
  double angle = 0.0;
  for (int k = 0; k < kSeconds * rate_hz; ++k) {
    const double t = k * dt, since = std::max(0.0, t - 1.0);
    const double rate = top_rad_s * (1.0 - std::cos(1.5 * since)) * 0.5, a = top_rad_s * 0.75 * std::sin(1.5 * since);
    angle += dt * rate;
    UnitReadings now;
    const Eigen::Vector3d up = so3::exp(-angle * axis) * Eigen::Vector3d::UnitZ(), w = rate * axis;
    for (std::size_t unit = 0; unit < kCount; ++unit) {
      now[unit].time_ns = std::llround(t * 1e9);
      now[unit].specific_force_m_s2 =
          kGravity_m_s2 * up + a * axis.cross(kPositions[unit]) + w.cross(w.cross(kPositions[unit]));
      now[unit].angular_velocity_rad_s = w;
      for (int j = 0; j < 3; ++j) {
        double& gyro = now[unit].angular_velocity_rad_s[j];
        double& force = now[unit].specific_force_m_s2[j];
        gyro = quantised(gyro + 1e-4 * wide * normal(random), 3.5e-4);
        force = quantised(force + 2e-3 * wide * normal(random), 7.5e-4);
      }
    }
    harm(t, now);
    std::optional<ImuSample> merged;
    const Status status = merge.step(now, out.state, merged);
    EXPECT_TRUE(status.ok()) << status.message();
    const Eigen::Vector3d position = (kPositions[0] + kPositions[1] + kPositions[2]) / 3.0;
    const Eigen::Vector3d force = kGravity_m_s2 * up + a * axis.cross(position) + w.cross(w.cross(position));
    if (t < 3.0) continue;
    out.worst_rate_rad_s = std::max(out.worst_rate_rad_s, (merged->angular_velocity_rad_s - w).norm());
    out.worst_force_m_s2 = std::max(out.worst_force_m_s2, (merged->specific_force_m_s2 - force).norm());
  }
  return out;
}

void nothing(double, UnitReadings&) {}

void expect_only(const HarmedMerge& out, std::size_t frozen, std::size_t disagrees) {
  for (std::size_t k = 0; k < kCount; ++k) {
    EXPECT_EQ(out.state.imus[k].is_frozen, k == frozen) << k;
    EXPECT_EQ(out.state.imus[k].disagrees, k == disagrees) << k;
  }
}

TEST(ImuMergeHealth, GoodUnitsAreNotBlamed) {
  for (const int rate_hz : {50, 250, 1000}) {
    for (const double top_rad_s : {0.0, 5.0, 20.0})
      expect_only(merge_harmed(rate_hz, top_rad_s, 1.0, nothing), kCount, kCount);
  }
  // at rest without noise, all readings are equal for ever
  expect_only(merge_harmed(250, 0.0, 0.0, nothing), kCount, kCount);
  // one IMU repeats its reading while the others are noisy
  ImuSample first;
  expect_only(merge_harmed(250, 0.0, 1.0,
                           [&first](double t, UnitReadings& now) {
                             if (t == 0.0) first = now[1];
                             now[1].angular_velocity_rad_s = first.angular_velocity_rad_s;
                             now[1].specific_force_m_s2 = first.specific_force_m_s2;
                           }),
              kCount, kCount);
}

TEST(ImuMergeHealth, SampleAndHoldIsNotFrozen) {
  UnitReadings held;
  int k = 0;
  expect_only(merge_harmed(1000, 5.0, 1.0,
                           [&](double, UnitReadings& now) {
                             if (k++ % 20 == 0) held = now;
                             for (std::size_t unit = 0; unit < kCount; ++unit) {
                               now[unit].angular_velocity_rad_s = held[unit].angular_velocity_rad_s;
                               now[unit].specific_force_m_s2 = held[unit].specific_force_m_s2;
                             }
                           }),
              kCount, kCount);
}

TEST(ImuMergeHealth, AUnitThatRepeatsItselfWhileTheOthersMoveIsFrozen) {
  const HarmedMerge good = merge_harmed(250, 5.0, 1.0, nothing);
  for (std::size_t unit = 0; unit < kCount; ++unit) {
    ImuSample last;
    const HarmedMerge out = merge_harmed(250, 5.0, 1.0, [&](double t, UnitReadings& now) {
      if (t < 2.0) last = now[unit];
      now[unit].angular_velocity_rad_s = last.angular_velocity_rad_s;
      now[unit].specific_force_m_s2 = last.specific_force_m_s2;
    });
    expect_only(out, unit, kCount);
    EXPECT_NEAR(seconds(out.state.imus[unit].frozen_since_ns), 1.996, 0.01);
    // from two instead of three IMUs, after 0.03 s of calibration from wrong differences
    EXPECT_LT(out.worst_rate_rad_s, 4.0 * good.worst_rate_rad_s);
    EXPECT_LT(out.worst_force_m_s2, 4.0 * good.worst_force_m_s2);  // and an acceleration from the gyro noise
  }
}

TEST(ImuMergeHealth, ForcesThatAllRepeatThemselvesWhileTheBodyTurnsAreFrozen) {
  UnitReadings last;
  const HarmedMerge out = merge_harmed(250, 5.0, 1.0, [&](double t, UnitReadings& now) {
    if (t < 2.0) last = now;
    for (std::size_t unit = 0; unit < kCount; ++unit) now[unit].specific_force_m_s2 = last[unit].specific_force_m_s2;
  });
  for (std::size_t k = 0; k < kCount; ++k) {
    EXPECT_TRUE(out.state.imus[k].is_frozen) << k;
    EXPECT_NEAR(seconds(out.state.imus[k].frozen_since_ns), 1.996, 0.01) << k;
  }
  const Status status = ImuMerge(unit_params()).verdict(out.state);
  EXPECT_EQ(status.error_code, ErrorCode::out_of_range);
  EXPECT_NEAR(status.value, 4.0, 0.05);
  EXPECT_TRUE(ImuMerge(unit_params()).verdict(merge_harmed(250, 5.0, 1.0, nothing).state).ok());
}

TEST(ImuMergeHealth, ForcesThatStayBecauseTheBodyTurnsAboutThemAreNot) {
  const ImuMerge merge(unit_params());
  ImuMerge::State state;
  std::optional<ImuSample> merged;
  const Eigen::Vector3d w(0.0, 0.0, 5.0);
  for (int k = 0; k < 1000; ++k) {
    UnitReadings now;
    for (std::size_t unit = 0; unit < kCount; ++unit) {
      now[unit] = {.time_ns = 4'000'000LL * k,
                   .angular_velocity_rad_s = w,
                   .specific_force_m_s2 = kGravity_m_s2 * Eigen::Vector3d::UnitZ()};
    }
    ASSERT_TRUE(merge.step(now, state, merged).ok());
  }
  EXPECT_FALSE(state.imus[0].is_frozen);
  EXPECT_TRUE(ImuMerge::verdict(state).ok());
}

TEST(ImuMergeHealth, AFrozenUnitThatMovesAgainIsBack) {
  ImuSample last;
  const HarmedMerge out = merge_harmed(250, 5.0, 1.0, [&](double t, UnitReadings& now) {
    if (t < 2.0) last = now[0];
    if (t > 4.0) return;
    now[0].angular_velocity_rad_s = last.angular_velocity_rad_s;
    now[0].specific_force_m_s2 = last.specific_force_m_s2;
  });
  expect_only(out, kCount, kCount);
  EXPECT_GT(out.state.imus[0].excluded_window_count, 400);
}

TEST(ImuMergeHealth, AUnitThatDiedIsAbsent) {
  const HarmedMerge out = merge_harmed(250, 5.0, 1.0, [](double t, UnitReadings& now) {
    if (t > 2.0) now[2].specific_force_m_s2.y() = std::numeric_limits<double>::quiet_NaN();
  });
  EXPECT_GT(out.state.imus[2].missing_samples, 900);
  EXPECT_NEAR(seconds(out.state.imus[2].missing_since_ns), 2.004, 0.005);
  EXPECT_LT(out.worst_rate_rad_s, 0.02);
  EXPECT_LT(out.worst_force_m_s2, 0.5);
}

// an IMU's readings before its silence belong to another motion, so they must not be used for calibration or timing
TEST(ImuMergeHealth, AUnitThatComesBackIsNotComparedWithWhatItReadBefore) {
  const HarmedMerge undisturbed = merge_harmed(250, 5.0, 1.0, nothing);
  for (const double back_s : {3.1, 3.3, 3.6, 4.0}) {
    const HarmedMerge out = merge_harmed(250, 5.0, 1.0, [&](double t, UnitReadings& now) {
      if (t > 1.6 && t < back_s) now[1].angular_velocity_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
    });
    EXPECT_LT(out.worst_rate_rad_s, 0.02) << back_s;
    EXPECT_LT(out.worst_force_m_s2, 0.5) << back_s;
    for (std::size_t k = 0; k < kCount; ++k) {
      EXPECT_LT((out.state.imus[k].x - undisturbed.state.imus[k].x).lpNorm<Eigen::Infinity>(), 1e-3) << back_s;
    }
    EXPECT_LT((out.state.forces.x - undisturbed.state.forces.x).lpNorm<Eigen::Infinity>(), 0.01) << back_s;
  }
}

TEST(ImuMergeHealth, AUnitThatDisagreesForLongIsLeftOutForGood) {
  const auto scaled = [](double, UnitReadings& now) {
    now[1].angular_velocity_rad_s *= 1.3;
    now[1].specific_force_m_s2 *= 1.3;
  };
  expect_only(merge_harmed(250, 5.0, 1.0, scaled), kCount, 1);
  const auto swapped = [](double, UnitReadings& now) {
    std::swap(now[0].angular_velocity_rad_s.x(), now[0].angular_velocity_rad_s.y());
    std::swap(now[0].specific_force_m_s2.x(), now[0].specific_force_m_s2.y());
  };
  const HarmedMerge out = merge_harmed(250, 5.0, 1.0, swapped);
  expect_only(out, kCount, 0);
  EXPECT_LT(out.worst_rate_rad_s, 0.02);
  // tolerated: 1 % of scale, 0.02 rad/s and 0.2 m/s^2 of bias
  expect_only(
      merge_harmed(250, 5.0, 1.0,
                   [](double, UnitReadings& now) {
                     now[1].angular_velocity_rad_s = 1.01 * now[1].angular_velocity_rad_s + Eigen::Vector3d(0.02, 0, 0);
                     now[1].specific_force_m_s2 = 1.01 * now[1].specific_force_m_s2 + Eigen::Vector3d(0, 0.2, 0);
                   }),
      kCount, kCount);
}

TEST(ImuMergeHealth, TheArmsTellAFlippedAxisOfAllGyros) {
  EXPECT_FALSE(merge_harmed(250, 5.0, 1.0, nothing).state.imu_sign_check.detected_mirroring().has_value());
  const HarmedMerge flipped = merge_harmed(250, 5.0, 1.0, [](double, UnitReadings& now) {
    for (ImuSample& sample : now) sample.angular_velocity_rad_s.x() *= -1.0;
  });
  const auto told = flipped.state.imu_sign_check.detected_mirroring();
  ASSERT_TRUE(told.has_value());
  EXPECT_EQ(told->mirroring, 0U);
  EXPECT_NEAR(told->explained_fraction, 1.0, 0.1);
}

TEST(ImuMergeHealth, TheArmsTellTheSignOfTheAccelerometers) {
  const auto share = [](const HarmedMerge& out) { return ImuMerge::lever_arm_agreement(out.state).value_or(0.0); };
  EXPECT_NEAR(share(merge_harmed(250, 5.0, 1.0, nothing)), 1.0, 0.05);
  EXPECT_NEAR(share(merge_harmed(1000, 5.0, 1.0, nothing)), 1.0, 0.05);
  const HarmedMerge flipped = merge_harmed(250, 5.0, 1.0, [](double, UnitReadings& now) {
    for (ImuSample& sample : now) sample.specific_force_m_s2 *= -1.0;
  });
  EXPECT_NEAR(share(flipped), -1.0, 0.05);
  EXPECT_FALSE(ImuMerge::lever_arm_agreement(merge_harmed(250, 0.0, 1.0, nothing).state).has_value());
}

}  // namespace
}  // namespace tumble
