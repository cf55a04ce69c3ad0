// SPDX-License-Identifier: BSD-3-Clause
// Tests the rate of a steady spin beyond the saturation limit.
#include "tumble/attitude/detail/spin_tracker.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

constexpr double kSpinRail_rad_s = 30.0, kSpinPeriod_s = 0.01, kSpinDuration_s = 8.0;

/// SteadySpin is a body that spins up about one gyro axis. The rate across the spin axis has a part that is constant in
/// the body, and a part that turns in body axes by -`turning` times the angle of the spin: 1 for a part that is
/// constant in the world.
struct SteadySpin {
  double turning = 1.0, across_rad_s = 3.0;
  int axis = 0;
  double sign = 1.0;

  double rate(double t) const { return sign * (15.0 + 35.0 * t / kSpinDuration_s); }
  double angle(double t) const { return sign * (15.0 * t + 17.5 * t * t / kSpinDuration_s); }
};

struct SpinRecording {
  std::vector<ImuSample> samples;
  std::vector<std::uint8_t> saturated_axes;
  std::vector<double> rate_rad_s;
};

SpinRecording record_spin(const SteadySpin& spin) {
  SpinRecording out;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (int k = 0; k < static_cast<int>(kSpinDuration_s / kSpinPeriod_s); ++k) {
    const double t = k * kSpinPeriod_s, phase = -spin.turning * spin.angle(t);
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(std::llround(1e9 * t));
    Eigen::Vector3d w;
    w[spin.axis] = spin.rate(t);
    w[(spin.axis + 1) % 3] = 0.5 + spin.across_rad_s * std::cos(phase) + noise(random);
    w[(spin.axis + 2) % 3] = -0.8 + spin.across_rad_s * std::sin(phase) + noise(random);
    out.rate_rad_s.push_back(w[spin.axis]);
    const bool saturated = std::abs(w[spin.axis]) > kSpinRail_rad_s;
    if (saturated) w[spin.axis] = std::copysign(kSpinRail_rad_s, w[spin.axis]);
    out.saturated_axes.push_back(static_cast<std::uint8_t>(saturated ? 1u << spin.axis : 0u));
    sample.angular_velocity_rad_s = w;
    sample.specific_force_m_s2 = Eigen::Vector3d(0.0, 0.0, 9.8);
    out.samples.push_back(sample);
  }
  return out;
}

struct SpinErrors {
  double median_rad_s = 0.0, p90_rad_s = 0.0, coverage = 0.0, probability_min = 1.0, probability_max = 0.0;
};

SpinErrors spin_errors(const SpinRecording& recording, const std::vector<SpinRate>& spins) {
  SpinErrors out;
  std::vector<double> all;
  for (std::size_t k = 0; k < spins.size(); ++k) {
    if (recording.saturated_axes[k] == 0) continue;
    EXPECT_TRUE(spins[k].saturated);
    const double error = std::abs(spins[k].rate_rad_s - recording.rate_rad_s[k]);
    all.push_back(error);
    out.coverage += error < 3.0 * std::sqrt(spins[k].variance_rad2_s2) ? 1.0 : 0.0;
    out.probability_min = std::min(out.probability_min, spins[k].probability);
    out.probability_max = std::max(out.probability_max, spins[k].probability);
  }
  std::sort(all.begin(), all.end());
  out.coverage /= static_cast<double>(all.size());
  out.median_rad_s = all[all.size() / 2];
  out.p90_rad_s = all[all.size() * 9 / 10];
  return out;
}

std::vector<SpinRate> track_spin(const SpinRecording& recording) {
  const SpinTracker tracker({});
  SpinTracker::State state;
  std::vector<SpinRate> out;
  for (std::size_t k = 0; k < recording.samples.size(); ++k)
    out.push_back(tracker.step(recording.samples[k], recording.saturated_axes[k], state));
  return out;
}

std::vector<SpinRate> smooth_spin(const SpinRecording& recording) {
  return SpinTracker({}).smooth(recording.samples, recording.saturated_axes);
}

// The phase of the modulation has an error of about 0.1/3 rad per sample. The filter averages the phase over about ten
// samples, so its rate is accurate to a few tenths of a rad/s.
TEST(SpinTracker, FollowsASpinBeyondTheSaturationLimit) {
  for (const int axis : {0, 1, 2}) {
    for (const double sign : {1.0, -1.0}) {
      SteadySpin spin;
      spin.axis = axis, spin.sign = sign;
      const SpinRecording recording = record_spin(spin);
      const SpinErrors live = spin_errors(recording, track_spin(recording)),
                       all = spin_errors(recording, smooth_spin(recording));
      EXPECT_LT(live.median_rad_s, 0.8) << axis << " " << sign;
      EXPECT_LT(live.p90_rad_s, 2.0) << axis << " " << sign;
      EXPECT_LT(all.median_rad_s, 0.4) << axis << " " << sign;
      EXPECT_LT(all.median_rad_s, live.median_rad_s);
      for (const SpinErrors& each : {live, all}) {
        EXPECT_GT(each.coverage, 0.97);
        EXPECT_GT(each.probability_min, 0.9);
      }
    }
  }
}

/// Replaces the specific force by that of a lever arm, of an air force that is constant in the world, and of noise. The
/// rate across the spin axis becomes noise.
SpinRecording with_force(const SteadySpin& spin, double turning) {
  SpinRecording out = record_spin(spin);
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.2);
  for (std::size_t k = 0; k < out.samples.size(); ++k) {
    const double t = static_cast<double>(k) * kSpinPeriod_s, phase = -turning * spin.angle(t), s = out.rate_rad_s[k];
    const int a = (spin.axis + 1) % 3, b = (spin.axis + 2) % 3;
    out.samples[k].specific_force_m_s2[a] = -s * s * 0.01 + 3.0 * std::cos(phase) + noise(random);
    out.samples[k].specific_force_m_s2[b] = s * s * 0.005 + 3.0 * std::sin(phase) + noise(random);
    out.samples[k].angular_velocity_rad_s[a] = out.samples[k].angular_velocity_rad_s[b] = noise(random);
  }
  return out;
}

TEST(SpinTracker, FollowsASpinByTheForceAlone) {
  for (const int axis : {0, 1, 2}) {
    SteadySpin spin;
    spin.axis = axis, spin.sign = axis == 1 ? -1.0 : 1.0;
    const SpinRecording recording = with_force(spin, 1.0);
    for (const SpinErrors& each :
         {spin_errors(recording, track_spin(recording)), spin_errors(recording, smooth_spin(recording))}) {
      EXPECT_LT(each.median_rad_s, 0.5) << axis;
      EXPECT_GT(each.coverage, 0.97) << axis;
      EXPECT_GT(each.probability_min, 0.9) << axis;
    }
  }
}

// Negative control: the force turns against the spin, and the rate across the spin axis is noise.
TEST(SpinTracker, RejectsAForceWithoutRelationToTheSpin) {
  SpinRecording recording = with_force({}, -1.0);
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    const double s = recording.rate_rad_s[k];
    recording.samples[k].specific_force_m_s2 += Eigen::Vector3d(0.0, s * s * 0.01, -s * s * 0.005);
  }
  EXPECT_LT(spin_errors(recording, track_spin(recording)).probability_max, 0.5);
}

// Negative control: the rate across the spin axis turns in the opposite sense, slower, or not at all.
TEST(SpinTracker, RejectsMotionWithoutRelationToTheSpin) {
  for (const double turning : {-1.0, 0.3, 0.0}) {
    SteadySpin spin;
    spin.turning = turning;
    const SpinRecording recording = record_spin(spin);
    EXPECT_LT(spin_errors(recording, track_spin(recording)).probability_max, 0.5) << turning;
    EXPECT_LT(spin_errors(recording, smooth_spin(recording)).probability_max, 0.5) << turning;
  }
}

// Without unsaturated samples, a modulation of another frequency is indistinguishable from that of the spin.
TEST(SpinTracker, SaturatedSamplesDoNotConfirmASpin) {
  SpinRecording recording = record_spin({});
  for (std::uint8_t& axes : recording.saturated_axes) axes = 1;
  for (const SpinRate& spin : track_spin(recording)) EXPECT_LT(spin.probability, 0.02);
}

TEST(SpinTracker, ChangesOnlySaturatedRates) {
  const SpinRecording recording = record_spin({});
  const std::vector<SpinRate> spins = track_spin(recording);
  const SpinTracker tracker({});
  AngularRateState rate;
  rate.w_WI_I_rad_s = Eigen::Vector3d(kSpinRail_rad_s, 1.0, 2.0);
  rate.covariance_rad2_s2 = Eigen::Vector3d(9.0, 0.25, 0.25).asDiagonal();
  for (std::size_t k = 0; k < spins.size(); ++k) {
    const AngularRateState combined = tracker.combine_with_spin_rate(rate, spins[k]);
    if (recording.saturated_axes[k] == 0) {
      EXPECT_EQ(combined.w_WI_I_rad_s, rate.w_WI_I_rad_s);
      EXPECT_EQ(combined.covariance_rad2_s2, rate.covariance_rad2_s2);
    } else {
      EXPECT_EQ(combined.w_WI_I_rad_s.x(), spins[k].rate_rad_s);
      EXPECT_EQ(combined.w_WI_I_rad_s.tail<2>(), rate.w_WI_I_rad_s.tail<2>());
    }
  }
  SpinRate improbable = spins.back();
  improbable.probability = 0.05;
  EXPECT_EQ(tracker.combine_with_spin_rate(rate, improbable).w_WI_I_rad_s, rate.w_WI_I_rad_s);
  EXPECT_EQ(tracker.combine_with_spin_rate(rate, spins.back(), true).w_WI_I_rad_s.x(), spins.back().rate_rad_s);
  rate.covariance_rad2_s2(0, 0) = 0.5 * spins.back().variance_rad2_s2;
  EXPECT_EQ(tracker.combine_with_spin_rate(rate, spins.back(), true).w_WI_I_rad_s, rate.w_WI_I_rad_s);
}

TEST(SpinTracker, ContinuesFromACopyOfTheState) {
  const SpinRecording recording = record_spin({});
  const SpinTracker tracker({});
  const std::vector<SpinRate> whole = track_spin(recording);
  SpinTracker::State state;
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    const SpinTracker::State copy = state;
    state = copy;
    EXPECT_EQ(tracker.step(recording.samples[k], recording.saturated_axes[k], state).rate_rad_s, whole[k].rate_rad_s);
  }
}

// After an overflow, the reading has the opposite sign. A bound with this sign would pull the rate through zero.
TEST(SpinTracker, IgnoresTheSignOfAnOverflowedReading) {
  SpinRecording recording = record_spin({});
  for (std::size_t k = 0; k < recording.samples.size(); ++k)
    if (recording.saturated_axes[k] != 0 && k % 3 == 0) recording.samples[k].angular_velocity_rad_s.x() *= -1.0;
  EXPECT_LT(spin_errors(recording, track_spin(recording)).median_rad_s, 0.8);
}

}  // namespace
}  // namespace tumble
