// SPDX-License-Identifier: BSD-3-Clause
// Tests bad input and splitting of the recursion.
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"

namespace tumble {
namespace {

SaturationAwareRateEstimator::Params stated_device() {
  SaturationAwareRateEstimator::Params params;
  params.lever_arm_m = {-0.022, -0.085, 0.055};
  params.saturation_point_rad_s = 10.5;
  return params;
}

std::vector<ImuSample> tumbling_run(std::size_t count) {
  std::vector<ImuSample> run(count);
  const Vector3d lever = stated_device().lever_arm_m;
  for (std::size_t k = 0; k < count; ++k) {
    const Vector3d w(9.0 + 4.0 * std::sin(0.05 * k), std::cos(0.03 * k), 0.4);
    run[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
    run[k].angular_velocity_rad_s = w.cwiseMin(10.6).cwiseMax(-10.6);
    run[k].specific_force_m_s2 = w.cross(w.cross(lever));
  }
  return run;
}

TEST(SaaveInput, SplittingTheRecursionAnywhereChangesNothing) {
  const SaturationAwareRateEstimator saave(stated_device());
  const std::vector<ImuSample> run = tumbling_run(120);
  std::vector<SaturationAwareRateEstimator::RecoveredRate> whole(run.size());
  SaturationAwareRateEstimator::State state;
  std::size_t clipped = 0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    ASSERT_TRUE(saave.step(run[k], state, whole[k]).ok());
    clipped += whole[k].clipped_axes != 0;
  }
  ASSERT_GT(clipped, 20u);
  for (std::size_t split = 0; split <= run.size(); split += 7) {
    SaturationAwareRateEstimator::State carried;
    SaturationAwareRateEstimator::RecoveredRate got;
    for (std::size_t k = 0; k < split; ++k) ASSERT_TRUE(saave.step(run[k], carried, got).ok());
    const SaturationAwareRateEstimator second(stated_device());
    for (std::size_t k = split; k < run.size(); ++k) {
      ASSERT_TRUE(second.step(run[k], carried, got).ok());
      ASSERT_EQ(got.rate_rad_s, whole[k].rate_rad_s);  // identical bits
      ASSERT_EQ(got.variance_rad2_s2, whole[k].variance_rad2_s2);
    }
    EXPECT_EQ(carried, state);
  }
}

TEST(SaaveInput, TroubleNamesFieldValueAndBoundAndWritesNothing) {
  const SaturationAwareRateEstimator saave(stated_device());
  std::vector<AngularRateState> out(2);
  out[1].clipped_axes = 5;
  const auto expect = [&](const std::vector<ImuSample>& run, ErrorCode error_code, const std::string& field) {
    const Status status = saave.estimate(run, out);
    EXPECT_EQ(status.error_code, error_code) << status.message();
    EXPECT_EQ(status.field, field);
    EXPECT_EQ(out.size(), 2u);
    EXPECT_EQ(out.at(1).clipped_axes, 5);
    return status;
  };
  EXPECT_EQ(expect({}, ErrorCode::empty, "samples").bound, 1.0);

  std::vector<ImuSample> run = tumbling_run(30);
  run[20].angular_velocity_rad_s.z() = std::nan("");
  EXPECT_TRUE(std::isnan(expect(run, ErrorCode::non_finite, "angular_velocity_rad_s").value));

  run = tumbling_run(30);
  run[20].specific_force_m_s2.x() = -INFINITY;
  EXPECT_EQ(expect(run, ErrorCode::non_finite, "specific_force_m_s2").value, -INFINITY);

  run = tumbling_run(30);
  run[7].time_ns = run[6].time_ns;
  EXPECT_EQ(expect(run, ErrorCode::time_order, "time_ns").value, 6e7);

  run = tumbling_run(30);
  run[7].time_ns = run[4].time_ns;
  const Status falling = expect(run, ErrorCode::time_order, "time_ns");
  EXPECT_EQ(falling.value, 4e7);
  EXPECT_EQ(falling.bound, 6e7);

  run = tumbling_run(30);
  for (std::size_t k = 9; k < run.size(); ++k) run[k].time_ns += 1'500'000'000;
  const Status gap = expect(run, ErrorCode::gap, "time_s since the last sample");
  EXPECT_DOUBLE_EQ(gap.value, 1.51);
  EXPECT_EQ(gap.bound, 1.0);
}

TEST(SaaveInput, AFailedStepLeavesTheStateUsable) {
  const SaturationAwareRateEstimator saave(stated_device());
  const std::vector<ImuSample> run = tumbling_run(60);
  SaturationAwareRateEstimator::State state, clean;
  SaturationAwareRateEstimator::RecoveredRate got, want;
  for (const ImuSample& sample : run) {
    ImuSample broken = sample;
    broken.angular_velocity_rad_s.x() = std::nan("");
    const SaturationAwareRateEstimator::State before = state;
    EXPECT_EQ(saave.step(broken, state, got).error_code, ErrorCode::non_finite);
    EXPECT_EQ(state, before);
    ASSERT_TRUE(saave.step(sample, state, got).ok());
    ASSERT_TRUE(saave.step(sample, clean, want).ok());
    EXPECT_EQ(got.rate_rad_s, want.rate_rad_s);
  }
}

TEST(SaaveInput, ASingleSampleIsReturnedAsItIs) {
  std::vector<AngularRateState> out;
  ASSERT_TRUE(SaturationAwareRateEstimator(stated_device()).estimate(std::vector<ImuSample>(1), out).ok());
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].w_WI_I_rad_s, Vector3d::Zero());
}

TEST(SaaveInput, RefusesParametersOutsideOfTheirBounds) {
  const auto refused = [](auto change) {
    SaturationAwareRateEstimator::Params params = stated_device();
    change(params);
    EXPECT_THROW(SaturationAwareRateEstimator{params}, InvalidParams);
  };
  EXPECT_NO_THROW(SaturationAwareRateEstimator{stated_device()});
  refused([](SaturationAwareRateEstimator::Params& p) {
    p.lever_arm_m = SaturationAwareRateEstimator::Params{}.lever_arm_m;
  });  // neither has a default
  refused([](SaturationAwareRateEstimator::Params& p) {
    p.saturation_point_rad_s = SaturationAwareRateEstimator::Params{}.saturation_point_rad_s;
  });
  refused([](SaturationAwareRateEstimator::Params& p) { p.lever_arm_m.y() = std::nan(""); });
  refused([](SaturationAwareRateEstimator::Params& p) { p.lever_arm_m.x() = 11.0; });
  refused([](SaturationAwareRateEstimator::Params& p) { p.saturation_point_rad_s = 0.0; });
  refused([](SaturationAwareRateEstimator::Params& p) { p.jerk_psd_rad2_s5 = 0.0; });
}

}  // namespace
}  // namespace tumble
