// SPDX-License-Identifier: BSD-3-Clause
// Tests the preparation of readings for the hand-held smoother: triads slower than the log, partly saturated windows,
// and the jerk in the readings.
#include "estimator/attitude/hand_held_motion.hpp"
#include "estimator/src/attitude/hand_held_problem.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::HandHeldMotion;

constexpr double kLog_s = 0.008, kGyro_s = 0.0201, kAccel_s = 0.0395, kRail_rad_s = 7.3;

Vector3d mean_rate(const HandHeldMotion& motion, double end_s, double window_s, bool clipped) {
  constexpr int kParts = 40;
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < kParts; ++i) {
    Vector3d rate = motion.rate(end_s - window_s * (i + 0.5) / kParts);
    if (clipped) rate.x() = std::clamp(rate.x(), -kRail_rad_s, kRail_rad_s);
    sum += rate / kParts;
  }
  return sum;
}

/// Held is a log faster than its triads, as for the pendulum of RepoIMU: the gyro is a mean over its own period,
/// clipped before averaging.
struct Held {
  std::vector<ImuSample> samples;
  std::vector<ClipSigns> signs;
  std::vector<Vector3d> rate_rad_s;  ///< true mean over the log's period
  std::vector<bool> lost;            ///< the reading is below the unclipped reading
};

/// `mark` is added to each repeated reading, more each time, so that it does not look repeated.
Held held(double duration_s, double mark) {
  const HandHeldMotion motion;
  Held out;
  for (int k = 1; k * kLog_s <= duration_s; ++k) {
    const double end_s = k * kLog_s;
    const double gyro_s = kGyro_s * std::floor(end_s / kGyro_s), accel_s = kAccel_s * std::floor(end_s / kAccel_s);
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(std::llround(1e9 * end_s));
    sample.angular_velocity_rad_s = mean_rate(motion, gyro_s, kGyro_s, true) + mark * k * Vector3d::UnitZ();
    sample.specific_force_m_s2 = motion.specific_force(accel_s - 0.25 * kAccel_s);
    ClipSigns signs;
    const double x = sample.angular_velocity_rad_s.x();
    if (std::abs(x) > kRail_rad_s - 1e-9) signs.gyro[0] = x > 0.0 ? 1 : -1;
    out.samples.push_back(sample);
    out.signs.push_back(signs);
    out.rate_rad_s.push_back(mean_rate(motion, end_s, kLog_s, false));
    out.lost.push_back(std::abs(x - mean_rate(motion, gyro_s, kGyro_s, false).x()) > 0.01);
  }
  return out;
}

struct HeldErrors {
  double median_rad_s = 0.0;  ///< errors of readings with a deficit
  double within = 0.0;        ///< their share within three deviations
  double called_measured = 0.0;
};

HeldErrors errors_of_held(const Held& recording) {
  std::vector<AngularRateState> rates;
  std::vector<AttitudeState> attitudes;
  HandHeldSmoother::Report report;
  SensingAxisClipSigns clipped;
  clipped.clip_signs = recording.signs;
  EXPECT_TRUE(HandHeldSmoother({}).estimate(recording.samples, clipped, rates, attitudes, report).ok());
  HeldErrors out;
  std::vector<double> errors;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (!recording.lost[k]) continue;
    const double error = std::abs(rates[k].w_WI_I_rad_s.x() - recording.rate_rad_s[k].x());
    errors.push_back(error);
    out.within += error < 3.0 * std::sqrt(rates[k].covariance_rad2_s2(0, 0)) ? 1.0 : 0.0;
    out.called_measured += rates[k].source == AngularRateSource::measured ? 1.0 : 0.0;
  }
  EXPECT_GT(errors.size(), 200u);
  if (errors.empty()) return out;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  out.median_rad_s = errors[errors.size() / 2];
  out.within /= static_cast<double>(errors.size());
  out.called_measured /= static_cast<double>(errors.size());
  return out;
}

/// Negative control: equal readings, but none repeats the previous one bit for bit, so each counts as new at its stamp.
/// Measured: 0.27 rad/s with all errors within the bounds; 0.66 and 0.94 in the control.
TEST(HandHeldReadings, ATriadSlowerThanTheLogIsReadOnceAndAtItsOwnTime) {
  const HeldErrors own = errors_of_held(held(12.0, 0.0)), again = errors_of_held(held(12.0, 1e-9));
  std::printf("own times: %.3f rad/s, within %.3f, called measured %.3f; as said again: %.3f, %.3f, %.3f\n",
              own.median_rad_s, own.within, own.called_measured, again.median_rad_s, again.within,
              again.called_measured);
  EXPECT_LT(own.median_rad_s, 0.6 * again.median_rad_s);
  EXPECT_GE(own.within, 0.97);
  EXPECT_LT(again.within, 0.97);
  EXPECT_LT(own.called_measured, 0.5 * again.called_measured + 1e-9);
}

/// For one draw of white jerk, read as means over windows, the density is found, and the mean over a window differs
/// from the rate at its centre by q P^3/320.
TEST(HandHeldReadings, TheJerkThatReadingsShowIsThatOfTheMotion) {
  constexpr double kPeriod_s = 0.01, kJerk = 600.0;
  constexpr int kParts = 51, kSamples = 4000;
  oracles::Gaussian noise(7);
  std::vector<ImuSample> samples;
  Vector3d rate = Vector3d::Zero(), acceleration = Vector3d::Zero();
  double apart = 0.0;
  const double step_s = kPeriod_s / kParts;
  for (int k = 1; k <= kSamples; ++k) {
    Vector3d sum = Vector3d::Zero(), centre = Vector3d::Zero();
    for (int i = 0; i < kParts; ++i) {
      // the rate is pulled back slowly, so that it stays bounded; the jerk of this pull is small
      const double z = noise(), y = noise(), x = noise();
      acceleration += kJerk * std::sqrt(step_s) * Vector3d(x, y, z) - step_s * (0.2 * acceleration + 0.1 * rate);
      rate += step_s * acceleration;
      sum += rate;
      if (i == kParts / 2) centre = rate;
    }
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(std::llround(1e9 * k * kPeriod_s));
    sample.angular_velocity_rad_s = sum / kParts;
    sample.specific_force_m_s2 = {0.0, 0.0, 9.8};
    samples.push_back(sample);
    apart += (sum / kParts - centre).squaredNorm() / (3.0 * kSamples);
  }
  const hand_held::NodeData collected = hand_held::collect_node_data({}, samples, {});
  double power = 0.0;
  for (const double jerk : collected.jerk) power += jerk * jerk / static_cast<double>(collected.jerk.size());
  const double expected = kJerk * kJerk * std::pow(kPeriod_s, 3.0) / 320.0;
  std::printf("root density %.1f, drawn %.1f; window %.5f, expected %.5f rad/s\n", std::sqrt(power), kJerk,
              std::sqrt(apart), std::sqrt(expected));
  // 12000 correlated second differences: accuracy of 2 % for the root density
  EXPECT_NEAR(std::sqrt(power), kJerk, 0.05 * kJerk);
  EXPECT_NEAR(std::sqrt(apart), std::sqrt(expected), 0.05 * std::sqrt(expected));
}

/// The rate swings far beyond the saturation level and reverses its slope while hidden, which the adjacent readings do
/// not reveal. Control: the same readings treated as unsaturated.
TEST(HandHeldReadings, TheJerkOfAHiddenSegmentIsThatOfTheSlopesAtItsEnds) {
  constexpr double kPeriod_s = 0.0035, kAmplitude_rad_s = 20.0, kTurn_rad_s = 21.0;
  std::vector<ImuSample> samples;
  std::vector<ClipSigns> signs;
  for (int k = 1; k <= 600; ++k) {
    // mean over the averaging window
    const double to_s = k * kPeriod_s, from_s = to_s - kPeriod_s;
    const double x =
        kAmplitude_rad_s * (std::cos(kTurn_rad_s * from_s) - std::cos(kTurn_rad_s * to_s)) / (kTurn_rad_s * kPeriod_s);
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(std::llround(1e9 * to_s));
    sample.angular_velocity_rad_s = {std::clamp(x, -kRail_rad_s, kRail_rad_s), 0.0, 0.0};
    sample.specific_force_m_s2 = {0.0, 0.0, 9.8};
    samples.push_back(sample);
    ClipSigns sign;
    if (std::abs(x) > kRail_rad_s) sign.gyro[0] = x > 0.0 ? 1 : -1;
    signs.push_back(sign);
  }
  SensingAxisClipSigns clipped;
  clipped.clip_signs = signs;
  const HandHeldSmoother::Params params;
  const hand_held::NodeData collected = hand_held::collect_node_data(params, samples, clipped);
  const std::vector<double> free = hand_held::collect_node_data(params, samples, {}).jerk;
  const double phase = std::asin(kRail_rad_s / kAmplitude_rad_s);
  const double change = 2.0 * kAmplitude_rad_s * kTurn_rad_s * std::cos(phase);
  const double clipped_duration_s = (3.141592653589793 - 2.0 * phase) / kTurn_rad_s;
  const double expected = change / std::sqrt(clipped_duration_s);
  const std::size_t top =
      static_cast<std::size_t>(std::lround(0.5 * 3.141592653589793 / kTurn_rad_s / params.expert.node_s));
  std::printf("hidden for %.3f s: root density %.0f, by the ends %.0f; taken for free %.0f\n", clipped_duration_s,
              collected.jerk[top], expected, free[top]);
  // the slopes are read a window outside of the segment, which is longer by this amount
  EXPECT_NEAR(collected.jerk[top], expected, 0.1 * expected);
  EXPECT_LT(free[top], 0.2 * expected);
}

}  // namespace
}  // namespace tumble
