// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/rest_gravity.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

using Harm = std::function<void(ImuSample&)>;

struct Span {
  Eigen::Vector3d rate_rad_s = {1.5, 2.0, -0.7};
  double turns_s = 3.0, rate_sigma_rad_s = 0.01;
  AngularRateSource source = AngularRateSource::measured;
  bool shaken = true;
};

// Returns an acceleration in the world over three whole periods per axis, whose velocity returns to zero.
Eigen::Vector3d shaken_m_s2(double share_of_turn) {
  constexpr double kRevolution_rad = 6.283185307179586;
  return {20.0 * std::sin(3.0 * kRevolution_rad * share_of_turn),
          30.0 * std::cos(3.0 * kRevolution_rad * share_of_turn),
          -15.0 * std::sin(6.0 * kRevolution_rad * share_of_turn)};
}

// Rest, then a constant rotation rate while shaken, and rest again: R is known in closed form.
RestGravity::State after(const Span& span, const Harm& harm, double scale_of_estimate = 1.0) {
  const RestGravity gravity({});
  RestGravity::State state;
  oracles::Gaussian noise(3);
  const Eigen::Vector3d up = Eigen::Vector3d(0.3, -0.2, 1.0).normalized();
  for (int k = 0; k < 700; ++k) {
    const double t_s = 0.01 * k, turned_s = std::clamp(t_s - 2.0, 0.0, span.turns_s);
    const bool turns = turned_s > 0.0 && turned_s < span.turns_s;
    ImuSample sample;
    sample.time_ns = TimeNs{k} * 10'000'000;
    if (turns || turned_s == span.turns_s)
      sample.angular_velocity_rad_s = turns ? span.rate_rad_s : Eigen::Vector3d(0, 0, 0);
    Eigen::Vector3d force = 9.80665 * up;
    if (turns && span.shaken) force += shaken_m_s2(turned_s / span.turns_s);
    sample.specific_force_m_s2 = so3::exp(turned_s * span.rate_rad_s).conjugate() * force;
    for (int j = 0; j < 3; ++j) sample.specific_force_m_s2[j] += 0.01 * noise();
    harm(sample);
    AngularRateState rate;
    rate.time_ns = sample.time_ns;
    rate.w_WI_I_rad_s = scale_of_estimate * sample.angular_velocity_rad_s;
    if (turns) rate.source = span.source;
    rate.covariance_rad2_s2 = span.rate_sigma_rad_s * span.rate_sigma_rad_s * Eigen::Matrix3d::Identity();
    gravity.step(sample, rate, state);
  }
  return state;
}

const Harm kNone = [](ImuSample&) {};

TEST(RestGravity, RatesCarryGravityFromOneRestToTheNext) {
  const RestGravity gravity({});
  const RestGravity::State good = after({}, kNone);
  EXPECT_TRUE(gravity.verdict(good).ok()) << gravity.verdict(good).message();
  EXPECT_EQ(good.compared_rest_pairs, 1u);
  EXPECT_LT(good.worst_velocity_error_ratio, 0.04);
}

TEST(RestGravity, AGyroOfAnotherSenseNamingOrScaleMisses) {
  const RestGravity gravity({});
  const std::string miss =
      "velocity error after integration from one rest to the next (share of gravity times elapsed time)";
  const auto says = [&](const Harm& harm) { return std::string(gravity.verdict(after({}, harm)).field); };
  EXPECT_EQ(says([](ImuSample& s) { s.angular_velocity_rad_s *= -1.0; }), miss);
  EXPECT_EQ(says([](ImuSample& s) { s.angular_velocity_rad_s.x() *= -1.0; }), miss);
  EXPECT_EQ(says([](ImuSample& s) { std::swap(s.angular_velocity_rad_s.x(), s.angular_velocity_rad_s.y()); }), miss);
  EXPECT_EQ(says([](ImuSample& s) { s.angular_velocity_rad_s *= 0.5; }), miss);
  EXPECT_EQ(says([](ImuSample& s) { s.angular_velocity_rad_s *= 2.0; }), miss);
}

TEST(RestGravity, AnAccelerometerOfAnotherUnitShowsInTheSize) {
  const RestGravity gravity({});
  for (const double scale : {0.5, 2.0, 1.0 / 9.80665}) {
    const RestGravity::State wrong = after({}, [=](ImuSample& s) { s.specific_force_m_s2 *= scale; });
    EXPECT_STREQ(gravity.verdict(wrong).field, scale > 1.0 / 3.0
                                                   ? "specific force at rest (share of gravity)"
                                                   : "accelerometer unit: specific force at rest (share of gravity)")
        << scale;
    EXPECT_NEAR(gravity.verdict(wrong).value, scale, 0.01);
  }
  EXPECT_TRUE(gravity.verdict(after({}, [](ImuSample& s) { s.specific_force_m_s2 *= 1.05; })).ok());
}

// The device reports "linear acceleration", which is zero at rest. A fall also reads zero, but after a rest with
// gravity.
TEST(RestGravity, AnAccelerometerWithoutGravityReadsNothingAtRest) {
  const RestGravity gravity({});
  const Harm taken_out = [](ImuSample& s) {
    if (s.angular_velocity_rad_s.isZero(0.0)) s.specific_force_m_s2 *= 0.01;
  };
  const RestGravity::State none = after({}, taken_out);
  EXPECT_EQ(none.rest_s, 0.0);
  EXPECT_GT(none.weightless_s, 2.0);
  EXPECT_STREQ(gravity.verdict(none).field, "specific force at rest (share of gravity)");
  EXPECT_EQ(gravity.verdict(none).value, 0.0);
  const RestGravity::State falls = after({}, [&](ImuSample& s) {
    if (s.time_ns > 5'000'000'000) taken_out(s);
  });
  EXPECT_GT(falls.weightless_s, 1.0);
  EXPECT_TRUE(gravity.verdict(falls).ok()) << gravity.verdict(falls).message();
}

TEST(RestGravity, WhatTheRatesStateIsAllowed) {
  const RestGravity gravity({});
  // 5 % of 7.8 rad: 0.3 to 0.4 rad
  const RestGravity::State sure = after({}, kNone, 1.05), unsure = after({.rate_sigma_rad_s = 0.12}, kNone, 1.05);
  EXPECT_FALSE(gravity.verdict(sure).ok());
  EXPECT_TRUE(gravity.verdict(unsure).ok()) << gravity.verdict(unsure).message();
  EXPECT_FALSE(gravity.verdict(after({.rate_sigma_rad_s = 5.0}, kNone, 0.5)).ok()) << "not of rates that say nothing";
}

// The hidden deficit may have been constant throughout, so the deviation of the rotation is that of the rate times the
// duration.
TEST(RestGravity, ErrorsOfAClippedSegmentLastAsLongAsIt) {
  // a rate with a constant error of 5 %, which it states
  const RestGravity gravity({});
  EXPECT_FALSE(gravity.verdict(after({.rate_sigma_rad_s = 0.025}, kNone, 1.05)).ok());
  const Status status =
      gravity.verdict(after({.rate_sigma_rad_s = 0.025, .source = AngularRateSource::lower_bound_only}, kNone, 1.05));
  EXPECT_TRUE(status.ok()) << status.message();
}

// After whole turns, gravity returns to its direction for the opposite sign or the doubled rate. Rotated back by such
// rates, the force moves about the axis a, and its mean is (a u) a: imu_merge.md (I25).
TEST(RestGravity, RatesThatMeetGravityByChanceLeaveAVelocity) {
  const RestGravity gravity({});
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 0.4, -0.1).normalized();
  const Span whole = {.rate_rad_s = 2.0 * 3.141592653589793 / 3.0 * axis};
  const RestGravity::State good = after(whole, kNone);
  EXPECT_TRUE(gravity.verdict(good).ok()) << gravity.verdict(good).message();
  const double across = axis.cross(Eigen::Vector3d(0.3, -0.2, 1.0).normalized()).norm();
  for (const double scale : {-1.0, 2.0}) {
    // gravity may be anywhere according to these rates; 3.0 s of the span are rotation, and 0.4 s are rest
    const Span unsure = {.rate_rad_s = whole.rate_rad_s, .rate_sigma_rad_s = 0.5, .shaken = false};
    const RestGravity::State wrong = after(unsure, kNone, scale);
    EXPECT_NEAR(wrong.worst_velocity_error_ratio, 2.0 * across * 3.0 / 3.4, 0.05) << scale;
    EXPECT_STREQ(gravity.verdict(wrong).field,
                 "velocity error after integration from one rest to the next (share of gravity times elapsed time)");
  }
}

// Wherever an angular error arises in the span, it counts as its angle, from both sides together.
TEST(RestGravity, OneErrorOfTheTurnLeavesNoMoreVelocityThanItMisses) {
  const RestGravity gravity({});
  for (const int at : {210, 350, 490}) {
    RestGravity::State state;
    for (int k = 0; k < 700; ++k) {
      ImuSample sample;
      sample.time_ns = TimeNs{k} * 10'000'000;
      const bool turns = k >= 200 && k < 500;
      if (turns) sample.angular_velocity_rad_s = {0.0, 0.0, 1.0};
      sample.specific_force_m_s2 = {0.0, 0.0, 9.80665};
      AngularRateState rate;
      rate.w_WI_I_rad_s = sample.angular_velocity_rad_s;
      if (k == at) rate.w_WI_I_rad_s.x() = 25.0;
      gravity.step(sample, rate, state);
    }
    EXPECT_NEAR(state.worst_velocity_error_ratio, 2.0 * std::sin(0.125), 3e-3) << at;
    EXPECT_TRUE(gravity.verdict(state).ok()) << gravity.verdict(state).message();
  }
}

// An impact of twice the measured force, for 0.3 s, and a long stop.
TEST(RestGravity, WhatTheAccelerometersRailHidIsAllowed) {
  constexpr double kRange_m_s2 = 30.0;
  const auto struck = [&](const RestGravity& gravity, bool told) {
    RestGravity::State state;
    for (int k = 0; k < 800; ++k) {
      ImuSample sample;
      sample.time_ns = TimeNs{k} * 10'000'000;
      const bool impact = k >= 200 && k < 230, halt = k >= 230 && k < 530;
      if (impact || halt) sample.angular_velocity_rad_s = {0.0, 0.0, 1.0};
      const double force_m_s2 = 9.80665 + (impact ? 50.0 : halt ? -5.0 : 0.0);
      sample.specific_force_m_s2 = {0.0, 0.0, std::min(force_m_s2, kRange_m_s2)};
      if (impact && told) sample.device_clip_flags = kClipAccelZ;
      AngularRateState rate;
      rate.w_WI_I_rad_s = sample.angular_velocity_rad_s;
      gravity.step(sample, rate, state);
    }
    return gravity.verdict(state);
  };
  EXPECT_FALSE(struck(RestGravity({}), false).ok()) << "nobody says that it clipped";
  EXPECT_TRUE(struck(RestGravity({}), true).ok()) << struck(RestGravity({}), true).message();
  EXPECT_TRUE(struck(RestGravity({.accel_range_m_s2 = kRange_m_s2}), false).ok());
  EXPECT_FALSE(struck(RestGravity({.accel_range_m_s2 = 2.0 * kRange_m_s2}), false).ok());
}

// The motion within a gap is unknown, so a span with a gap compares nothing, however accurate its ends are.
TEST(RestGravity, OfASpanWithAGapNothingIsSaid) {
  const auto silent_for = [](TimeNs gap_ns) {
    return Harm([gap_ns](ImuSample& sample) {
      if (sample.time_ns >= 3'000'000'000 && sample.time_ns < 3'000'000'000 + gap_ns)
        sample.specific_force_m_s2.x() = std::numeric_limits<double>::quiet_NaN();  // the sample is skipped
    });
  };
  EXPECT_EQ(after({}, silent_for(300'000'000)).compared_rest_pairs, 0u);
  EXPECT_EQ(after({}, silent_for(80'000'000)).compared_rest_pairs, 1u);
}

TEST(RestGravity, OfOneRestOrATurnAboutTheVerticalNothingIsSaid) {
  const RestGravity gravity({});
  EXPECT_TRUE(gravity.verdict({}).ok());
  EXPECT_EQ(after({.turns_s = 10.0}, kNone, -1.0).compared_rest_pairs, 0u);
  const Eigen::Vector3d about_up = 2.0 * Eigen::Vector3d(0.3, -0.2, 1.0).normalized();
  EXPECT_TRUE(gravity.verdict(after({.rate_rad_s = about_up}, kNone, -1.0)).ok());
  EXPECT_THROW(RestGravity({.gravity_m_s2 = 0.0}), InvalidParams);
}

TEST(RestGravity, ReadingsThatAreNoneAndStampsOutOfOrderArePassedOver) {
  const RestGravity gravity({});
  RestGravity::State state;
  ImuSample sample;
  sample.time_ns = std::numeric_limits<TimeNs>::min();
  sample.specific_force_m_s2 = {0.0, 0.0, 9.80665};
  gravity.step(sample, {}, state);
  for (int k = 0; k < 300; ++k) {
    sample.time_ns = TimeNs{k} * 10'000'000;
    gravity.step(sample, {}, state);
    ImuSample none = sample;
    none.specific_force_m_s2.setConstant(std::numeric_limits<double>::quiet_NaN());
    gravity.step(none, {}, state);
    none = sample;
    none.time_ns = 0;
    gravity.step(none, {}, state);
  }
  EXPECT_GT(state.rest_s, 0.0);
  EXPECT_TRUE(gravity.verdict(state).ok()) << gravity.verdict(state).message();
}

}  // namespace
}  // namespace tumble
