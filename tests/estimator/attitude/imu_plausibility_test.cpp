// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_plausibility.hpp"

#include "estimator/attitude/filter_contract.hpp"
#include "estimator/rolling/rolling_truth.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

Status verdict_of(const std::function<void(ImuSample&)>& harm, TimeNs period_ns = 4'000'000) {
  const testing::RollingTruth truth = testing::roll({.velocity_m_s = testing::l_shape,
                                                     .contact_velocity_m_s = testing::no_slip,
                                                     .lever_arm_m = {0.02, -0.01, 0.03},
                                                     .q_start = so3::exp({0.1, -0.2, 0.0}),
                                                     .period_ns = period_ns});
  const ImuPlausibility plausibility({});
  ImuPlausibility::State state;
  for (ImuSample sample : truth.samples) {
    harm(sample);
    plausibility.step(sample, state);
  }
  return plausibility.verdict(state);
}

TEST(ImuPlausibility, ARollOfASphereIsPlausibleAtEveryRate) {
  for (const TimeNs period_ns : {20'000'000, 4'000'000, 500'000}) {
    const Status status = verdict_of([](ImuSample&) {}, period_ns);
    EXPECT_TRUE(status.ok()) << status.message();
  }
  // biases and scales far beyond a data sheet's must not count as a wrong unit
  EXPECT_TRUE(verdict_of([](ImuSample& sample) {
                sample.angular_velocity_rad_s =
                    1.05 * sample.angular_velocity_rad_s + Eigen::Vector3d(0.05, 0.0, -0.05);
                sample.specific_force_m_s2 = 0.9 * sample.specific_force_m_s2 + Eigen::Vector3d(0.0, 0.5, 0.0);
              }).ok());
}

TEST(ImuPlausibility, AnotherScaleOrSignOfTheGyroIsNot) {
  for (const double scale : {57.29578, 1.0 / 57.29578, -1.0, 2.0, 0.5})
    EXPECT_STREQ(verdict_of([=](ImuSample& sample) { sample.angular_velocity_rad_s *= scale; }).field,
                 "ratio of gravity's rotation (accelerometer) to the rotation measured by the gyro")
        << scale;
}

testing::RollingTruth l_roll() {
  return testing::roll({.velocity_m_s = testing::l_shape,
                        .contact_velocity_m_s = testing::no_slip,
                        .q_start = so3::exp({0.1, -0.2, 0.0})});
}

TEST(ImuPlausibility, OfABodyAtRestOrReadingsThatAreNoneNothingIsSaid) {
  const ImuPlausibility plausibility({});
  ImuPlausibility::State state;
  EXPECT_TRUE(plausibility.verdict(state).ok());
  ImuSample sample;
  sample.specific_force_m_s2.setConstant(std::numeric_limits<double>::quiet_NaN());
  plausibility.step(sample, state);
  EXPECT_FALSE(state.started);
  sample.specific_force_m_s2 = {0.0, 0.0, 9.8};
  sample.time_ns = std::numeric_limits<TimeNs>::min();
  plausibility.step(sample, state);
  for (TimeNs k = 0; k < 2500; ++k) {
    sample.time_ns = k * 4'000'000;
    plausibility.step(sample, state);
  }
  EXPECT_TRUE(plausibility.verdict(state).ok());
  EXPECT_THROW(ImuPlausibility({.gravity_m_s2 = 0.0}), InvalidParams);
}

// Returns a body at rest, then in the air and spinning: the sensor measures w x (w x r), which is constant and rotates
// with it.
ImuPlausibility::State of_a_throw(double spin_rad_s, double arm_m) {
  const ImuPlausibility plausibility({});
  ImuPlausibility::State state;
  ImuSample sample;
  for (int k = 0; k < 300; ++k) {
    sample.time_ns = TimeNs{k} * 10'000'000;
    const Eigen::Vector3d rate(0.0, k < 100 ? 0.0 : spin_rad_s, 0.0), arm(arm_m, 0.0, 0.0);
    sample.angular_velocity_rad_s = rate;
    sample.specific_force_m_s2 = k < 100 ? Eigen::Vector3d(0.0, 0.0, 9.80665) : rate.cross(rate.cross(arm));
    plausibility.step(sample, state);
  }
  return state;
}

TEST(ImuPlausibility, OfABodyThatFliesAndSpinsTheTurningIsNotAsked) {
  const ImuPlausibility plausibility({});
  const Status thrown = plausibility.verdict(of_a_throw(12.0, 0.1));  // 14 m/s^2
  EXPECT_TRUE(thrown.ok()) << thrown.message();
}

/// Returns the verdict on a body that never rotates. Quick pushes tilt the measured force by 0.3 rad about x (12 times)
/// or y (8 times), and the force returns slowly. The gyro measures `rate_rad_s` about x.
Status of_pushes(double rate_rad_s) {
  const ImuPlausibility plausibility({});
  ImuPlausibility::State state;
  ImuSample sample;
  for (int k = 0; k < 2000; ++k) {
    const double t_s = 0.01 * (k % 100), tilt_rad = 0.3 * (t_s < 0.2 ? 5.0 * t_s : 1.25 * (1.0 - t_s));
    const Eigen::Vector3d axis = k / 100 % 10 < 8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    sample.time_ns = TimeNs{k} * 10'000'000;
    sample.angular_velocity_rad_s = {rate_rad_s, 0.0, k % 2 == 0 ? 1e-3 : -1e-3};
    sample.specific_force_m_s2 = so3::exp(Eigen::Vector3d(-tilt_rad * axis)) * Eigen::Vector3d(0.0, 0.0, 9.80665);
    plausibility.step(sample, state);
  }
  return plausibility.verdict(state);
}

TEST(ImuPlausibility, AZeroOffsetOfTheGyroDoesNotExplainPushes) {
  for (const double offset_deg_s : {1.0, 5.0, 8.0})
    EXPECT_TRUE(of_pushes(offset_deg_s / 57.29578).ok()) << of_pushes(offset_deg_s / 57.29578).message();
  EXPECT_FALSE(of_pushes(0.5).ok());  // negative control: no gyro has this zero offset
}

// Returns the state after the motion of a pendulum. A hand lifts the pendulum twice far aside and back, then a little
// aside, and releases it. The force of a free pendulum always points along its rod.
ImuPlausibility::State of_a_pendulum(double gyro_scale) {
  constexpr double kLength_m = 0.5, kDt_s = 0.01;
  constexpr double kFar_rad = 1.2, kLittle_rad = 0.35, kLift_s = 0.7, kBack_s = 2.8, kLet_go_s = 3.5;
  const auto lifted = [](double to_rad, double t_s) {
    return 0.5 * to_rad * (1.0 - std::cos(std::numbers::pi * t_s / kLift_s));
  };
  const ImuPlausibility plausibility({});
  ImuPlausibility::State state;
  ImuSample sample;
  double angle = 0.0, rate = 0.0;
  for (int k = 0; k < 800; ++k) {
    const double t_s = kDt_s * k, before = angle;
    const bool held = t_s < kLet_go_s;
    if (held) {
      angle = t_s < kBack_s ? lifted(kFar_rad, t_s) : lifted(kLittle_rad, t_s - kBack_s);
    } else {
      rate -= kDt_s * testing::kGravity_m_s2 / kLength_m * std::sin(angle);
      angle += kDt_s * rate;
    }
    sample.time_ns = TimeNs{k} * 10'000'000;
    sample.angular_velocity_rad_s = {0.0, gyro_scale * (angle - before) / kDt_s, 0.0};
    sample.specific_force_m_s2 =
        held ? testing::kGravity_m_s2 * Eigen::Vector3d(-std::sin(angle), 0.0, std::cos(angle))
             : Eigen::Vector3d(0.0, 0.0, testing::kGravity_m_s2 * std::cos(angle) + kLength_m * rate * rate);
    plausibility.step(sample, state);
  }
  return state;
}

TEST(ImuPlausibility, APendulumIsCheckedByItsLiftNotByItsSwing) {
  const ImuPlausibility plausibility({});
  const ImuPlausibility::State good = of_a_pendulum(1.0);
  EXPECT_TRUE(plausibility.verdict(good).ok()) << plausibility.verdict(good).message();
  EXPECT_NEAR(plausibility.force_to_gyro_rotation_ratio(good), 1.0, 0.1);
  for (const double scale : {-1.0, 0.5, 2.0}) {
    const ImuPlausibility::State wrong = of_a_pendulum(scale);
    EXPECT_FALSE(plausibility.verdict(wrong).ok()) << scale;
    EXPECT_NEAR(plausibility.force_to_gyro_rotation_ratio(wrong), 1.0 / scale, 0.1) << scale;
  }
}

// Pushes and a wrong gyro scale both change the slope. A corrected scale reduces the residual only if the gyro's scale
// is wrong.
TEST(ImuPlausibility, ASlopeIsReportedWhereItExplainsTheResidualOfTheGyro) {
  const ImuPlausibility plausibility({});
  const auto verdict_at = [&](double force_rotation_rad2, double correlation) {
    ImuPlausibility::State state;
    constexpr double kRotated_rad2 = 10.0;  // rotation angle by the gyro, far more than the excluded part
    state.force_rotation_square_sum_rad2 = kRotated_rad2 * force_rotation_rad2;
    state.gyro_rotation_square_sum_rad2 = kRotated_rad2;
    state.rotated_window_count = 100.0;
    state.unexplained_force_rotation_rad2 =
        kRotated_rad2 * (force_rotation_rad2 + 1.0 - 2.0 * correlation * std::sqrt(force_rotation_rad2));
    EXPECT_NEAR(plausibility.rotation_agreement(state), correlation, 1e-9);
    return plausibility.verdict(state).ok();
  };
  EXPECT_TRUE(verdict_at(1.0, 0.4));
  EXPECT_TRUE(verdict_at(0.48, 0.78)) << "a pendulum whose lift was pushed: swing 62043, slope 0.54";
  EXPECT_TRUE(verdict_at(0.76, 0.245)) << "swing 62045, slope 0.21";
  EXPECT_FALSE(verdict_at(1.0, -0.4)) << "another sense";
  EXPECT_FALSE(verdict_at(4.0, -0.26)) << "another sense, and pushes: swing 81201, slope -0.5";
  EXPECT_FALSE(verdict_at(0.12, 0.78)) << "the first with twice the rate";
  EXPECT_FALSE(verdict_at(4.0, 0.9)) << "half the scale";
  EXPECT_FALSE(verdict_at(0.3 * 0.3, 0.4)) << "a multiple of it";
  EXPECT_FALSE(verdict_at(4.9, 0.9)) << "half the scale, and pushes";
  // a hand that swings the sensor about an external point also pushes the sensor, with or against the rotation
  EXPECT_TRUE(verdict_at(8.0, 0.62)) << "BROAD 07, a good gyro, slope 1.75";
  EXPECT_TRUE(verdict_at(9.0, 0.526)) << "BROAD 11, slope 1.58";
  EXPECT_TRUE(verdict_at(14.1, -0.13)) << "BROAD 27, slope -0.49";
}

// In the run `hill` 85124, the flight contains one window in which the force at the IMU has the magnitude of gravity
// and rotates.
TEST(ImuPlausibility, AFewWindowsSayNothingOfTheTurning) {
  const ImuPlausibility plausibility({});
  const auto after_rotations = [&](int turns) {
    ImuPlausibility::State state;
    for (int k = 0; k < 400; ++k) {
      const double t_s = 0.01 * k, angle = 3.0 * std::clamp(t_s - 1.0, 0.0, 0.2 * turns);
      plausibility.step({.time_ns = TimeNs{k} * 10'000'000,
                         .angular_velocity_rad_s = {0.0, 0.0, t_s > 1.0 && t_s < 1.0 + 0.2 * turns ? 3.0 : 0.0},
                         .specific_force_m_s2 = 9.80665 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0)},
                        state);
    }
    return plausibility.verdict(state);
  };
  EXPECT_TRUE(after_rotations(2).ok()) << after_rotations(2).message();
  EXPECT_FALSE(after_rotations(8).ok()) << "the other sense throughout";
}

TEST(ImuPlausibility, WhereTheGyroIsAtItsRailNothingIsCompared) {
  const testing::RollingTruth truth = l_roll();
  const ImuPlausibility plausibility({.gyro_range_rad_s = 1.0});
  ImuPlausibility::State state;
  for (ImuSample sample : truth.samples) {
    sample.angular_velocity_rad_s = sample.angular_velocity_rad_s.cwiseMax(-1.0).cwiseMin(1.0);
    plausibility.step(sample, state);
  }
  EXPECT_TRUE(plausibility.verdict(state).ok()) << plausibility.verdict(state).message();
}

// Returns a body at rest, with noise; from `from_s` on, a triad repeats its reading for `for_s`.
ImuPlausibility::State with_a_hold(bool gyro, double from_s, double for_s, double before_s = 0.0) {
  const ImuPlausibility plausibility({});
  ImuPlausibility::State state;
  oracles::Gaussian noise(5);
  ImuSample sample;
  for (int k = 0; k < 800; ++k) {
    const double t_s = 0.01 * k;
    const bool holds = (t_s >= from_s && t_s < from_s + for_s) || t_s < before_s;
    sample.time_ns = TimeNs{k} * 10'000'000;
    Eigen::Vector3d rate, force;
    for (int j = 0; j < 3; ++j) rate[j] = 0.005 * noise(), force[j] = (j == 2 ? 9.8 : 0.0) + 0.006 * noise();
    if (!(holds && gyro)) sample.angular_velocity_rad_s = rate;
    if (!(holds && !gyro)) sample.specific_force_m_s2 = force;
    plausibility.step(sample, state);
  }
  return state;
}

TEST(ImuPlausibility, ATriadThatRepeatsItselfIsFrozen) {
  const ImuPlausibility plausibility({});
  for (const bool gyro : {true, false}) {
    EXPECT_TRUE(plausibility.verdict(with_a_hold(gyro, 20.0, 0.0)).ok());
    EXPECT_TRUE(plausibility.verdict(with_a_hold(gyro, 4.0, 0.5)).ok()) << "half a second was lost";
    EXPECT_TRUE(plausibility.verdict(with_a_hold(gyro, 4.0, 1.5, 1.0)).ok()) << "so it does at the start";
    const ImuPlausibility::State frozen = with_a_hold(gyro, 4.0, 4.0);
    EXPECT_EQ(plausibility.verdict(frozen).error_code, ErrorCode::out_of_range);
    EXPECT_NEAR(plausibility.frozen_s(frozen), 4.0, 0.05);
    EXPECT_FALSE(plausibility.verdict(with_a_hold(gyro, 3.0, 2.0)).ok()) << "and says so when it has come back";
  }
}

// Returns a body that rests or rolls, with a gyro or an accelerometer that always reads `dead`.
ImuPlausibility::State with_a_dead(bool gyro, bool turns, double dead) {
  const ImuPlausibility plausibility({});
  ImuPlausibility::State state;
  oracles::Gaussian noise(5);
  for (int k = 0; k < 800; ++k) {
    ImuSample sample;
    sample.time_ns = TimeNs{k} * 10'000'000;
    const double rate = turns ? 2.0 : 0.0, angle = 0.01 * k * rate;
    sample.angular_velocity_rad_s = {0.005 * noise(), rate + 0.005 * noise(), 0.0};
    sample.specific_force_m_s2 = {-9.8 * std::sin(angle), 0.006 * noise(), 9.8 * std::cos(angle) + 0.006 * noise()};
    (gyro ? sample.angular_velocity_rad_s : sample.specific_force_m_s2).setConstant(dead);
    plausibility.step(sample, state);
  }
  return state;
}

TEST(ImuPlausibility, ATriadThatNeverMovedIsDeadWhereTheOtherMeasuresARotation) {
  const ImuPlausibility plausibility({});
  for (const double dead : {0.0, 0.01}) {
    const ImuPlausibility::State gyro = with_a_dead(true, true, dead);
    EXPECT_STREQ(plausibility.verdict(gyro).field, "time in s for which gyro or accelerometer repeats one reading")
        << dead;
    EXPECT_NEAR(plausibility.frozen_s(gyro), 8.0, 0.05) << dead;
    EXPECT_TRUE(plausibility.verdict(with_a_dead(true, false, dead)).ok()) << "a coarse gyro at rest";
  }
  EXPECT_STREQ(plausibility.verdict(with_a_dead(false, true, 0.0)).field,
               "time in s for which gyro or accelerometer repeats one reading");
}

TEST(ImuPlausibility, AGyroThatNeverMovedIsDeadWhereTheBodyIsPushed) {
  const auto frozen_s = [](double push_m_s2, double rate_rad_s) {
    const ImuPlausibility plausibility({});
    ImuPlausibility::State state;
    for (int k = 0; k < 500; ++k) {
      const double up = 9.81 + (k >= 200 && k < 260 ? push_m_s2 : 0.0);
      const double rate = k % 2 == 0 ? rate_rad_s : 0.0;
      plausibility.step({k * TimeNs{10'000'000}, {rate, 0.0, 0.0}, {0.0, 0.0, up}, 0}, state);
    }
    return plausibility.frozen_s(state);
  };
  EXPECT_GT(frozen_s(20.0, 0.0), 4.0);
  EXPECT_EQ(frozen_s(20.0, 0.001), 0.0) << "it moves";
  EXPECT_EQ(frozen_s(2.0, 0.0), 0.0) << "a device that rests with a coarse quantum";
}

TEST(ImuPlausibility, AGyroThatIsSaturatedOnAllAxesIsNotFrozen) {
  const auto frozen_s = [](double reading_rad_s) {
    const ImuPlausibility plausibility({.gyro_range_rad_s = 30.0});
    ImuPlausibility::State state;
    for (int k = 0; k < 600; ++k) {
      ImuSample sample{k * TimeNs{10'000'000}, {}, {0.01 * k, 0.0, 9.81}, 0};
      sample.angular_velocity_rad_s.setConstant(k < 200 ? 0.1 * k : -reading_rad_s);
      plausibility.step(sample, state);
    }
    return plausibility.frozen_s(state);
  };
  EXPECT_EQ(frozen_s(30.5), 0.0);
  EXPECT_NEAR(frozen_s(29.5), 4.0, 0.05) << "within the range, a repeated reading is a fault";
}

}  // namespace
}  // namespace tumble
