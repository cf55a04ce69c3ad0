// SPDX-License-Identifier: BSD-3-Clause
// Tests bad and unusual input of the batch smoother, which returns a status or a finite and bounded answer.
#include "estimator/angular_velocity/tumble_recording.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

namespace tumble {
namespace {

TumbleRecording short_tumble() {
  TumbleOptions options;
  options.seed = 2;
  options.flights = 3;
  return make_tumble(options);
}

std::vector<AngularRateState> sound_rates(const std::vector<ImuSample>& samples, AngularRateReport& report) {
  std::vector<AngularRateState> out;
  const Status status =
      AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(samples, out, report);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(out.size(), samples.size());
  for (const AngularRateState& state : out) {
    EXPECT_TRUE(state.w_WI_I_rad_s.allFinite());
    EXPECT_LT(state.w_WI_I_rad_s.norm(), 100.0);
    EXPECT_TRUE(state.covariance_rad2_s2.allFinite());
    EXPECT_GT(state.covariance_rad2_s2.diagonal().minCoeff(), 0.0);
    EXPECT_LT(state.covariance_rad2_s2.diagonal().maxCoeff(), 2500.1);  // square of the bound on rates
  }
  return out;
}

TEST(RateSmootherInput, TroubleNamesFieldValueAndBoundAndWritesNothing) {
  const AngularRateSmoother smoother(with_lever_arm<AngularRateSmoother::Params>());
  std::vector<AngularRateState> out(2);
  AngularRateReport report;
  report.iterations = 77;
  const auto expect = [&](const std::vector<ImuSample>& samples, ErrorCode error_code, const std::string& field) {
    const Status status = smoother.estimate(samples, out, report);
    EXPECT_EQ(status.error_code, error_code) << status.message();
    EXPECT_EQ(status.field, field);
    EXPECT_EQ(out.size(), 2u);
    EXPECT_EQ(report.iterations, 77);
    return status;
  };
  const std::vector<ImuSample> good = short_tumble().samples;
  expect({}, ErrorCode::empty, "samples");
  EXPECT_EQ(expect({good[0]}, ErrorCode::insufficient_data, "samples").bound, 2.0);
  std::vector<ImuSample> bad = good;
  bad[50].angular_velocity_rad_s.y() = std::nan("");
  EXPECT_TRUE(std::isnan(expect(bad, ErrorCode::non_finite, "angular_velocity_rad_s").value));
  bad = good;
  bad[50].specific_force_m_s2.y() = INFINITY;
  expect(bad, ErrorCode::non_finite, "specific_force_m_s2");
  bad = good;
  bad[50].time_ns = bad[49].time_ns;
  EXPECT_EQ(expect(bad, ErrorCode::time_order, "time_ns").bound, 5e8);
  bad = good;
  bad[50].time_ns = bad[40].time_ns;
  expect(bad, ErrorCode::time_order, "time_ns");
}

TEST(RateSmootherInput, LongGapsSeparateTheRatesAndNotTheCalibration) {
  TumbleRecording tumble = short_tumble();
  AngularRateReport report;
  const std::vector<AngularRateState> expected = sound_rates(tumble.samples, report);
  for (std::size_t k = 50; k < tumble.samples.size(); ++k) tumble.samples[k].time_ns += 20'000'000'000;
  const std::vector<AngularRateState> found = sound_rates(tumble.samples, report);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (k >= 40 && k <= 60) continue;
    EXPECT_LT((found[k].w_WI_I_rad_s - expected[k].w_WI_I_rad_s).norm(), 0.1) << k;
  }
}

TEST(RateSmootherInput, ShortGapsAreBridged) {
  TumbleRecording tumble = short_tumble();
  tumble.samples.erase(tumble.samples.begin() + 100, tumble.samples.begin() + 107);
  AngularRateReport report;
  sound_rates(tumble.samples, report);
}

TEST(RateSmootherInput, AllAxesClippedForSecondsWithoutFlight) {
  std::vector<ImuSample> samples(600);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
    const bool clipped = k >= 100 && k < 500;
    samples[k].angular_velocity_rad_s = clipped ? Vector3d(10.5, -10.5, 10.5) : Vector3d(1.0, -1.0, 1.0);
    samples[k].specific_force_m_s2 = {3.0, -40.0, 60.0};  // the force points outwards, which no rotation causes
  }
  AngularRateReport report;
  const std::vector<AngularRateState> out = sound_rates(samples, report);
  EXPECT_EQ(report.clipped_sample_count, 400u);
  EXPECT_GT(report.lower_bound_only, 300u);
  EXPECT_GT(out[300].w_WI_I_rad_s.x(), 10.3);
  EXPECT_LT(out[300].w_WI_I_rad_s.y(), -10.3);
  EXPECT_GT(out[300].covariance_rad2_s2(0, 0), 0.1);  // far larger than the variance of the bound's noise
}

TEST(RateSmootherInput, ADeadAxis) {
  TumbleRecording tumble = short_tumble();
  for (ImuSample& sample : tumble.samples) sample.angular_velocity_rad_s.z() = 0.0;
  AngularRateReport report;
  sound_rates(tumble.samples, report);
}

TEST(RateSmootherInput, OverflowsAreRejected) {
  TumbleOptions options;
  options.seed = 13;
  options.speed_low_rad_s = 14.0;
  options.roll = false;
  TumbleRecording tumble = make_tumble(options);
  std::size_t flips = 0;
  for (std::size_t k = 1; k < tumble.samples.size(); ++k) {
    // in every seventh sample, a reading at the saturation level overflows if the previous reading is also at the
    // saturation level
    Vector3d& reading = tumble.samples[k].angular_velocity_rad_s;
    for (int j = 0; j < 3; ++j) {
      const double before = tumble.samples[k - 1].angular_velocity_rad_s[j];
      if (k % 7 == 3 && std::abs(reading[j]) == 10.5 && before == reading[j]) {
        reading[j] = -reading[j];
        ++flips;
      }
    }
  }
  ASSERT_GT(flips, 5u);
  AngularRateReport report;
  const std::vector<AngularRateState> out = sound_rates(tumble.samples, report);
  EXPECT_GE(report.missing_readings, flips / 2);
  EXPECT_LT(clipped_errors(tumble, rates_of(out), 10.49).median, 0.05);
}

TEST(RateSmootherInput, ReportsWhenTheStatedRangeIsWrong) {
  TumbleOptions options;
  options.seed = 13;
  TumbleRecording tumble = make_tumble(options);
  auto params = with_lever_arm<AngularRateSmoother::Params>();
  params.saturation_detector.stated_gyro_range_rad_s = 7.854;  // stated range of a device that clips at 10.5
  std::vector<AngularRateState> out;
  AngularRateReport report;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(tumble.samples, out, report).ok());
  EXPECT_TRUE(report.contradicts_stated_range[0] || report.contradicts_stated_range[1] ||
              report.contradicts_stated_range[2]);
  EXPECT_EQ(report.saturation_limits[0].value_or(0.0), 10.5);
}

TEST(RateSmootherInput, RefusesParametersOutsideOfTheirBounds) {
  const auto refused = [](auto change) {
    auto params = with_lever_arm<AngularRateSmoother::Params>();
    change(params);
    EXPECT_THROW(AngularRateSmoother{params}, InvalidParams);
  };
  EXPECT_THROW(AngularRateSmoother{{}}, InvalidParams) << "the lever arm has no default";
  refused([](AngularRateSmoother::Params& p) { p.expert.optimisation.iterations_max = 0; });
  refused([](AngularRateSmoother::Params& p) { p.expert.optimisation.tolerance_rad_s = 0.0; });
  refused([](AngularRateSmoother::Params& p) { p.model.nominal.lever_arm_m.x() = std::nan(""); });
  refused([](AngularRateSmoother::Params& p) { p.model.lever_arm_sigma_m = 0.0; });
  refused([](AngularRateSmoother::Params& p) { p.saturation_detector.stated_gyro_range_rad_s = -1.0; });
  refused([](AngularRateSmoother::Params& p) {
    p.model.calibration = BodyImuCalibration{{}, -BodyImuConstants::Matrix::Identity()};
  });
}

}  // namespace
}  // namespace tumble
