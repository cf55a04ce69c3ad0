// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::testing {

inline constexpr double kGravity_m_s2 = 9.80665;
inline constexpr TimeNs kPeriod_ns = 4'000'000;

/// Returns the angle of the sensor's z axis from the vertical [rad].
inline double tilt(const Eigen::Quaterniond& q_WI) {
  const Eigen::Vector3d up = q_WI.conjugate() * Eigen::Vector3d::UnitZ();
  return std::atan2(std::hypot(up.x(), up.y()), up.z());
}

/// Returns samples of a wobbling body, 250 Hz: smooth rates on all axes and a force that is not pure gravity.
inline std::vector<ImuSample> wobble(int count) {
  std::vector<ImuSample> samples;
  for (int k = 0; k < count; ++k) {
    const double t = k * seconds(kPeriod_ns);
    samples.push_back({k * kPeriod_ns,
                       {1.3 * std::sin(2.0 * t), 0.9 * std::cos(3.1 * t + 0.4), -0.6 + 0.5 * std::sin(1.1 * t)},
                       {1.5 * std::sin(1.7 * t) - 2.0, 1.0 + 0.8 * std::cos(2.9 * t), 9.0 + 0.7 * std::sin(4.3 * t)},
                       0});
  }
  return samples;
}

template <typename Filter>
typename Filter::State run(const Filter& filter, const std::vector<ImuSample>& samples, std::size_t from,
                           std::size_t to, typename Filter::State state = {}) {
  for (std::size_t k = from; k < to; ++k) {
    const Status status = filter.step(samples[k], state);
    EXPECT_TRUE(status.ok()) << "sample " << k << ": " << status.message();
  }
  return state;
}

/// Two runs, and a run that is split at some sample, end with identical bits.
template <typename Filter>
void expect_split_runs_equal(const Filter& filter) {
  const std::vector<ImuSample> samples = wobble(3000);
  const typename Filter::State whole = run(filter, samples, 0, samples.size());
  ASSERT_TRUE(whole.started);
  EXPECT_TRUE(whole == run(filter, samples, 0, samples.size()));
  for (const std::size_t cut : {1UL, 2UL, 997UL, 2999UL}) {
    const typename Filter::State carried = run(filter, samples, 0, cut);
    EXPECT_FALSE(whole == carried) << "cut " << cut << ": a comparison that cannot fail";
    EXPECT_TRUE(whole == run(filter, samples, cut, samples.size(), carried)) << "cut " << cut;
  }
}

template <typename Filter>
void expect_refused(const Filter& filter, const typename Filter::State& state, const ImuSample& sample,
                    ErrorCode error_code) {
  typename Filter::State after = state;
  const Status status = filter.step(sample, after);
  EXPECT_EQ(status.error_code, error_code) << status.message() << ", expected " << to_string(error_code);
  EXPECT_TRUE(after == state) << "the state changed on " << to_string(error_code);
}

/// Each kind of bad input gives its Status and leaves the state unchanged; a good sample afterwards is accepted.
template <typename Filter>
void expect_bad_input_refused(const Filter& filter) {
  const std::vector<ImuSample> samples = wobble(100);
  const typename Filter::State state = run(filter, samples, 0, 99);
  const ImuSample& good = samples[99];
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    ImuSample bad = good;
    bad.angular_velocity_rad_s[axis] = kNan;
    expect_refused(filter, state, bad, ErrorCode::non_finite);
    bad = good;
    bad.specific_force_m_s2[axis] = -kInfinity;
    expect_refused(filter, state, bad, ErrorCode::non_finite);
    bad = good;
    bad.angular_velocity_rad_s[axis] = 1e300;
    expect_refused(filter, state, bad, ErrorCode::out_of_range);
  }
  ImuSample bad = good;
  bad.time_ns = state.last_time_ns;
  expect_refused(filter, state, bad, ErrorCode::time_order);
  bad.time_ns = std::numeric_limits<TimeNs>::min();
  expect_refused(filter, state, bad, ErrorCode::time_order);
  bad.time_ns = state.last_time_ns + 1'000'000'001;  // the longest gap is 1 s
  expect_refused(filter, state, bad, ErrorCode::gap);
  bad.time_ns = std::numeric_limits<TimeNs>::max();
  expect_refused(filter, state, bad, ErrorCode::gap);

  ImuSample first = samples[0];
  first.time_ns = std::numeric_limits<TimeNs>::min();
  typename Filter::State long_ago;
  EXPECT_TRUE(filter.step(first, long_ago).ok());
  expect_refused(filter, long_ago, good, ErrorCode::gap);

  ImuSample weightless = good;
  weightless.specific_force_m_s2.setZero();
  expect_refused(filter, typename Filter::State{}, weightless, ErrorCode::degenerate);

  typename Filter::State after = state;
  EXPECT_TRUE(filter.step(weightless, after).ok()) << "free fall must integrate the gyro alone";
  EXPECT_TRUE(after.q_WI.coeffs().allFinite());
  after = state;
  EXPECT_TRUE(filter.step(good, after).ok());
}

/// A stream with -q instead of q in the state gives the same rotation.
template <typename Filter>
void expect_sign_of_q_is_free(const Filter& filter) {
  const std::vector<ImuSample> samples = wobble(500);
  typename Filter::State state = run(filter, samples, 0, 250);
  typename Filter::State opposite = state;
  opposite.q_WI.coeffs() = -opposite.q_WI.coeffs();
  state = run(filter, samples, 250, 500, state);
  opposite = run(filter, samples, 250, 500, opposite);
  // measured: 0, because every operation is odd or even in q
  EXPECT_NEAR(so3::logarithm(state.q_WI.conjugate() * opposite.q_WI).norm(), 0.0, 1e-14);
}

}  // namespace tumble::testing
