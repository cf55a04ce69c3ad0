// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/binned_metric.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/perfect_estimate.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

using testing::perfect_estimate;
using testing::scores;

/// Returns the bins of an axis that have a value of the base metric.
std::map<double, double> bins_of(const std::map<std::string, double>& values, const std::string& base,
                                 const std::string& axis) {
  std::map<double, double> bins;
  for (const auto& [name, value] : values) {
    const auto bin = parse_binned(name);
    if (bin && bin->base == base && bin->axis == axis) bins[bin->low] = value;
  }
  return bins;
}

TEST(BinnedMetric, NamesComeBack) {
  const BinnedMetric bin{"rate_error_median_rad_s", "clip_length_s", 0.405, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(bin.name(), "rate_error_median_rad_s@clip_length_s:0.405:inf");
  const auto back = parse_binned(bin.name());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->base, bin.base);
  EXPECT_EQ(back->axis, bin.axis);
  EXPECT_EQ(back->low, bin.low);
  EXPECT_EQ(back->high, bin.high);
  for (const char* other : {"rate_error_median_rad_s", "a@b", "a@b:1", "a@b:1:", "a@b:x:2", "a@b:1:2x", ""})
    EXPECT_FALSE(parse_binned(other)) << other;
}

// the synthetic rig turns about one axis, up to 14 rad/s: only the y axis is saturated, up to 2.9 rad/s deep, in one
// segment
TEST(BinnedScores, AnErrorOfDeepSamplesStaysInTheirBins) {
  const sim::Recording recording = testing::synthetic_rig();
  const ClippingTruth truth(recording.sensors, recording.truth);
  Estimate estimate = perfect_estimate(recording);
  std::size_t deep = 0, shallow = 0;
  for (std::size_t k = 0; k < estimate.rates.size(); ++k) {
    if (truth.clipped_axes(k) == 0) {
      estimate.rates[k].w_WI_I_rad_s.x() += 50.0;  // this error must not affect any score
    } else if (truth.depth_rad_s(k) >= 1.0) {
      estimate.rates[k].w_WI_I_rad_s.x() += 3.0;
      ++deep;
    } else {
      ++shallow;
    }
  }
  ASSERT_GT(deep, 10u);
  ASSERT_GT(shallow, 10u);
  const auto values = scores(Kind::rate, estimate, recording);
  for (const char* base : {"rate_error_median_rad_s", "rate_error_p99_rad_s"}) {
    const auto bins = bins_of(values, base, "clip_depth_rad_s");
    ASSERT_GE(bins.size(), 3u);
    for (const auto& [low, value] : bins) EXPECT_NEAR(value, low >= 1.0 ? 3.0 : 0.0, 1e-12) << base << " from " << low;
    EXPECT_FALSE(bins.contains(8.0)) << "no sample is so deep";
  }
}

TEST(BinnedScores, SortByLengthOfTheSegmentAndByTheNumberOfAxes) {
  sim::Recording recording = testing::synthetic_rig();
  sim::ImuRecord& imu = recording.sensors.imus.front();
  sim::ImuTruth& exact = recording.truth.imus.front();
  // the test replaces all saturation: one segment of 3 samples on one axis, one of 12 on two; at 200 Hz these are 0.015
  // s and 0.06 s
  imu.gyro_rad_s = exact.gyro_unclipped_rad_s;
  for (std::size_t k = 100; k < 103; ++k) imu.gyro_rad_s[k].x() -= 2.0;
  for (std::size_t k = 200; k < 212; ++k) imu.gyro_rad_s[k] -= Vector3d(0.0, 2.0, 1.0);
  Estimate estimate = perfect_estimate(recording);
  for (std::size_t k = 100; k < 103; ++k) estimate.rates[k].w_WI_I_rad_s.x() += 1.0;
  for (std::size_t k = 200; k < 212; ++k) estimate.rates[k].w_WI_I_rad_s.x() += 2.0;
  const auto values = scores(Kind::rate, estimate, recording);
  const auto lengths = bins_of(values, "rate_error_median_rad_s", "clip_length_s");
  ASSERT_EQ(lengths.size(), 2u);
  EXPECT_NEAR(lengths.at(0.0), 1.0, 1e-12);
  EXPECT_NEAR(lengths.at(0.055), 2.0, 1e-12);
  const auto axes = bins_of(values, "rate_error_median_rad_s", "clipped_axes");
  ASSERT_EQ(axes.size(), 2u);
  EXPECT_NEAR(axes.at(1.0), 1.0, 1e-12);
  EXPECT_NEAR(axes.at(2.0), 2.0, 1e-12);
}

// The test checks that the coverage of saturated axes and of axes with a cross-axis error are two numbers.
TEST(ClippedAxes, CrossAxisErrorsHaveTheirOwnCoverage) {
  sim::Recording recording = testing::synthetic_rig();
  sim::ImuTruth& imu = recording.truth.imus.front();
  Matrix3d elements = Eigen::Matrix3d::Identity();
  elements(0, 1) = 0.05;
  for (int i = 0; i < 3; ++i) imu.gyro_elements.emplace_back(elements.row(i));
  std::vector<Vector3d>& readings = recording.sensors.imus.front().gyro_rad_s;
  readings = imu.gyro_unclipped_rad_s;
  for (std::size_t k = 600; k < 700; ++k) readings[k] -= elements.inverse() * Vector3d(0.0, 3.0, 0.0);
  Estimate estimate = perfect_estimate(recording);
  for (AngularRateState& rate : estimate.rates) {
    rate.covariance_rad2_s2 = 0.01 * Eigen::Matrix3d::Identity();
    rate.w_WI_I_rad_s += Vector3d(0.5, 0.1, 9.0);  // z is neither clipped nor affected
  }
  const auto values = scores(Kind::rate, estimate, recording);
  EXPECT_EQ(values.at("rate_coverage_3sigma"), 1.0);
  EXPECT_EQ(values.at("rate_coverage_3sigma_cross_axis"), 0.0);
  EXPECT_FALSE(scores(Kind::rate, perfect_estimate(testing::synthetic_rig()), testing::synthetic_rig())
                   .contains("rate_coverage_3sigma_cross_axis"));
}

}  // namespace
}  // namespace tumble::scenarios
