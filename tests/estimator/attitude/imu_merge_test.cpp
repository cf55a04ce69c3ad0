// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_merge.hpp"

#include "estimator/attitude/filter_contract.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

using testing::kGravity_m_s2;

constexpr double kGyroRange = 34.9, kAccelRange = 200.0;
constexpr TimeNs kUnitPeriod_ns = 4'000'000;

/// Spin contains three IMUs at 8 cm about the centre of a body that turns about a fixed level axis.
struct Spin {
  std::array<Eigen::Vector3d, 3> position_m{{{0.08, 0.0, 0.01}, {-0.04, 0.069, 0.01}, {-0.04, -0.069, 0.01}}};
  Eigen::Vector3d axis = Eigen::Vector3d(0.2, 0.95, -0.24).normalized();

  /// Returns a rate that rises to `top` within 0.4 s, stays, and falls again.
  double rate(double t, double top) const { return top * std::clamp(std::min(t, 2.0 - t) / 0.4, 0.0, 1.0); }
  double acceleration(double t, double top) const { return (rate(t + 1e-4, top) - rate(t - 1e-4, top)) / 2e-4; }

  ImuSample sample(std::size_t unit, int k, double angle, double top) const {
    const double t = seconds(k * kUnitPeriod_ns);
    const Eigen::Vector3d w = rate(t, top) * axis, a = acceleration(t, top) * axis;
    const Eigen::Vector3d up = so3::exp(-angle * axis) * Eigen::Vector3d::UnitZ();
    ImuSample out;
    out.time_ns = k * kUnitPeriod_ns;
    out.angular_velocity_rad_s = w.cwiseMax(-kGyroRange).cwiseMin(kGyroRange);
    out.specific_force_m_s2 = kGravity_m_s2 * up + a.cross(position_m[unit]) + w.cross(w.cross(position_m[unit]));
    out.specific_force_m_s2 = out.specific_force_m_s2.cwiseMax(-kAccelRange).cwiseMin(kAccelRange);
    return out;
  }
};

ImuMerge::Setup spin_params(const Spin& spin, const Eigen::Vector3d& first_arm_error_m = Eigen::Vector3d::Zero()) {
  ImuMerge::Setup out;
  out.count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    out.T_mean_imu[k] = Eigen::Isometry3d::Identity();
    out.T_mean_imu[k].translation() = spin.position_m[k];
  }
  out.T_mean_imu[0].translation() += first_arm_error_m;
  out.gyro_range_rad_s = 0.98 * kGyroRange;
  out.accel_range_m_s2 = 0.98 * kAccelRange;
  return out;
}

struct MergeErrors {
  double rate_error_rad_s = 0.0;     ///< largest error after 0.1 s at the saturation limit
  double clipped_error_rad_s = 0.0;  ///< error of a single gyro
  int railed = 0, flagged = 0;
};

MergeErrors merge_errors(const Spin& spin, const ImuMerge::Setup& p, double top) {
  const ImuMerge merge(p);
  ImuMerge::State state;
  MergeErrors out;
  double angle = 0.0;
  int since = 0;
  for (int k = 0; k <= 500; ++k) {
    const double t = seconds(k * kUnitPeriod_ns);
    angle += seconds(kUnitPeriod_ns) * spin.rate(t, top);
    const std::array<ImuSample, 3> now = {spin.sample(0, k, angle, top), spin.sample(1, k, angle, top),
                                          spin.sample(2, k, angle, top)};
    std::optional<ImuSample> merged;
    EXPECT_TRUE(merge.step(now, state, merged).ok());
    const Eigen::Vector3d truth = spin.rate(t, top) * spin.axis;
    since = truth.cwiseAbs().maxCoeff() > kGyroRange ? since + 1 : 0;
    out.railed += since > 0;
    out.flagged += merged->device_clip_flags != 0;
    if (since <= 25) continue;
    out.rate_error_rad_s = std::max(out.rate_error_rad_s, (merged->angular_velocity_rad_s - truth).norm());
    out.clipped_error_rad_s = std::max(out.clipped_error_rad_s, (now[0].angular_velocity_rad_s - truth).norm());
  }
  return out;
}

TEST(ImuMerge, EstimatesARateBeyondTheRangeFromTheAccelerometers) {
  const Spin spin;
  const MergeErrors exact = merge_errors(spin, spin_params(spin), 44.0);
  ASSERT_GT(exact.railed, 100);
  EXPECT_GT(exact.clipped_error_rad_s, 5.0);  // the test needs a large raw error
  EXPECT_LT(exact.rate_error_rad_s, 0.5);
  EXPECT_EQ(exact.flagged, 0);
  // the mounting is wrong by 1 mm, which is calibrated below saturation
  const MergeErrors askew = merge_errors(spin, spin_params(spin, {1e-3, -1e-3, 1e-3}), 44.0);
  EXPECT_LT(askew.rate_error_rad_s, 1.0);
}

TEST(ImuMerge, BelowTheRangeTheMeanIsLeftAlone) {
  const Spin spin;
  const ImuMerge merge(spin_params(spin));
  ImuMerge::State state;
  double angle = 0.0;
  for (int k = 0; k <= 500; ++k) {
    const double t = seconds(k * kUnitPeriod_ns);
    angle += seconds(kUnitPeriod_ns) * spin.rate(t, 30.0);
    const std::array<ImuSample, 3> now = {spin.sample(0, k, angle, 30.0), spin.sample(1, k, angle, 30.0),
                                          spin.sample(2, k, angle, 30.0)};
    std::optional<ImuSample> merged;
    ASSERT_TRUE(merge.step(now, state, merged).ok());
    EXPECT_LT((merged->angular_velocity_rad_s - spin.rate(t, 30.0) * spin.axis).norm(), 1e-9) << k;
    EXPECT_EQ(merged->device_clip_flags, 0) << k;
  }
}

TEST(ImuMerge, LeavesOutTheOneThatDisagrees) {
  const Spin spin;
  const ImuMerge merge(spin_params(spin));
  ImuMerge::State state;
  std::optional<ImuSample> merged;
  for (int k = 0; k < 50; ++k) {
    std::array<ImuSample, 3> now = {spin.sample(0, 0, 0.0, 0.0), spin.sample(1, 0, 0.0, 0.0),
                                    spin.sample(2, 0, 0.0, 0.0)};
    for (ImuSample& sample : now) sample.time_ns = k * kUnitPeriod_ns;
    if (k >= 25) now[1].angular_velocity_rad_s.x() += 1.0;
    ASSERT_TRUE(merge.step(now, state, merged).ok());
    EXPECT_LT(merged->angular_velocity_rad_s.norm(), 1e-9) << k;
    EXPECT_NEAR(merged->specific_force_m_s2.norm(), kGravity_m_s2, 1e-9) << k;
  }
  EXPECT_EQ(state.imus[1].excluded_window_count, 25);
  EXPECT_EQ(state.imus[0].excluded_window_count, 0);
}

/// Returns what the mean of all IMUs should read at their mean position.
Eigen::Vector3d exact_force(const Spin& spin, int k, double angle, double top) {
  const double t = seconds(k * kUnitPeriod_ns);
  const Eigen::Vector3d w = spin.rate(t, top) * spin.axis, a = spin.acceleration(t, top) * spin.axis;
  const Eigen::Vector3d p = (spin.position_m[0] + spin.position_m[1] + spin.position_m[2]) / 3.0;
  return kGravity_m_s2 * (so3::exp(-angle * spin.axis) * Eigen::Vector3d::UnitZ()) + a.cross(p) + w.cross(w.cross(p));
}

TEST(ImuMerge, TakesOutMisalignmentsThatLargeForcesShow) {
  const Spin spin;
  const ImuMerge merge(spin_params(spin));
  ImuMerge::State state;
  std::array<Eigen::Matrix3d, 3> errors;  // their sum is zero, because common errors are unobservable
  errors[0] << 3e-3, -2e-3, 1e-3, 2e-3, -1e-3, 3e-3, -3e-3, 1e-3, 2e-3;
  errors[1] << -1e-3, 3e-3, 2e-3, -3e-3, 2e-3, -1e-3, 1e-3, 2e-3, -3e-3;
  errors[2] = -errors[0] - errors[1];
  double angle = 0.0, plain = 0.0, corrected = 0.0;
  for (int k = 0; k <= 500; ++k) {
    angle += seconds(kUnitPeriod_ns) * spin.rate(seconds(k * kUnitPeriod_ns), 25.0);
    std::array<ImuSample, 3> now;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t unit = 0; unit < 3; ++unit) {
      now[unit] = spin.sample(unit, k, angle, 25.0);
      now[unit].specific_force_m_s2 += (errors[unit] * now[unit].specific_force_m_s2).eval();
      mean += now[unit].specific_force_m_s2 / 3.0;
    }
    std::optional<ImuSample> merged;
    ASSERT_TRUE(merge.step(now, state, merged).ok());
    if (k < 250 || k >= 395) continue;  // the rate is constant from 0.4 to 1.6 s
    const Eigen::Vector3d exact = exact_force(spin, k, angle, 25.0);
    plain = std::max(plain, (mean - exact).norm());
    corrected = std::max(corrected, (merged->specific_force_m_s2 - exact).norm());
  }
  EXPECT_GT(plain, 0.1);  // the test needs a large error
  EXPECT_LT(corrected, 0.3 * plain);
}

TEST(ImuMerge, LeavesOutASaturationLimitThatAnImpactHides) {
  const Spin spin;
  const ImuMerge merge(spin_params(spin));
  ImuMerge::State state;
  for (int k = 0; k < 50; ++k) {
    std::array<ImuSample, 3> now = {spin.sample(0, 0, 0.0, 0.0), spin.sample(1, 0, 0.0, 0.0),
                                    spin.sample(2, 0, 0.0, 0.0)};
    const bool impact = k == 25;
    for (std::size_t unit = 0; unit < 3; ++unit) {
      now[unit].time_ns = k * kUnitPeriod_ns;
      if (impact) now[unit].specific_force_m_s2.x() += unit == 1 ? 20.0 : 50.0;  // far from the limit, on average
    }
    std::optional<ImuSample> merged;
    ASSERT_TRUE(merge.step(now, state, merged).ok());
    EXPECT_NEAR(merged->specific_force_m_s2.x(), impact ? 50.0 : 0.0, 1e-6) << k;
    EXPECT_EQ(merged->device_clip_flags, 0) << k;
  }
  EXPECT_EQ(state.imus[1].excluded_window_count, 10);  // for 40 ms, because impacts follow each other
  EXPECT_EQ(state.imus[0].excluded_window_count, 0);
}

TEST(ImuMerge, RefusesBadInput) {
  const Spin spin;
  ImuMerge::Setup bad = spin_params(spin);
  bad.gyro_range_rad_s = 0.0;
  EXPECT_THROW(ImuMerge{bad}, InvalidParams);
  bad = spin_params(spin);
  bad.count = 5;
  EXPECT_THROW(ImuMerge{bad}, InvalidParams);
  const ImuMerge merge(spin_params(spin));
  ImuMerge::State state;
  std::optional<ImuSample> merged;
  const std::array<ImuSample, 2> two{};
  EXPECT_EQ(merge.step(two, state, merged).error_code, ErrorCode::insufficient_data);
  EXPECT_EQ(state.sample_count, 0);
}

}  // namespace
}  // namespace tumble
