// SPDX-License-Identifier: BSD-3-Clause
// Tests the smoother on gyros whose elements clip along their own axes, without flags and without a stated range.
#include "estimator/angular_velocity/drawn_elements.hpp"
#include "estimator/angular_velocity/quantile.hpp"
#include "estimator/angular_velocity/tumble_recording.hpp"
#include "estimator/src/angular_velocity/possible_saturation.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

namespace tumble {
namespace {

using testing::quantile;

Pool smoothed(double tilt, const AngularRateSmoother::Params& params = with_lever_arm<AngularRateSmoother::Params>(),
              std::uint64_t devices = 10) {
  Pool pool;
  for (std::uint64_t seed = 1; seed <= devices; ++seed) {
    const TumbleRecording tumble = tilted_tumble(seed, tilt);
    std::vector<AngularRateState> states;
    AngularRateReport report;
    EXPECT_TRUE(AngularRateSmoother(params).estimate(tumble.samples, states, report).ok());
    pool.add(tumble, states);
  }
  return pool;
}

TEST(RateElements, ATiltedRailIsReadAsWellAsAnUprightOne) {
  const Pool upright = smoothed(0.0), tilted = smoothed(0.02), steep = smoothed(0.05);
  ASSERT_GT(tilted.ours.size(), 1000u);
  EXPECT_LT(quantile(tilted.ours, 0.5), 0.02 * quantile(tilted.raw, 0.5));
  EXPECT_LT(quantile(tilted.ours, 0.5), 1.3 * quantile(upright.ours, 0.5));
  EXPECT_LT(quantile(steep.ours, 0.5), 1.5 * quantile(upright.ours, 0.5));
  EXPECT_LT(quantile(tilted.ours, 0.99), 1.3 * quantile(upright.ours, 0.99));
  // what clipped elements hide on other axes is restored: uncorrected, 2 % of several rad/s would remain
  EXPECT_LT(quantile(tilted.free_axes, 0.5), 0.02);
}

TEST(RateElements, TheCovarianceHoldsTheErrorAndIsNotTooWide) {
  // measured at 5 %: 0.983; missing samples are in impacts, or few samples of elements whose level was never observed
  for (const double tilt : {0.02, 0.05}) {
    const double share = smoothed(tilt).share_within();
    EXPECT_GT(share, 0.98) << tilt;
    EXPECT_LT(share, 0.9999) << tilt;
  }
}

// Negative control: without planes and certain of axis-aligned levels, the same smoother accepts the wrong readings.
TEST(RateElements, WithoutPlanesItWouldBeSilentlyWrong) {
  auto params = with_lever_arm<AngularRateSmoother::Params>();
  params.expert.gyro_planes.distance_min_rad_s = 1000.0;
  params.model.element_sigma = 1e-6;
  const Pool pool = smoothed(0.02, params, 3);
  EXPECT_GT(quantile(pool.ours, 0.5), 0.5 * quantile(pool.raw, 0.5));
  EXPECT_LT(pool.share_within(), 0.8);
}

TEST(RateElements, WhatIsLearntOfTheElementsIsNearTheTruth) {
  TumbleOptions options;
  options.gyro_rows = drawn_rows(4, 0.04);
  const TumbleRecording tumble = make_tumble(options);
  std::vector<AngularRateState> states;
  AngularRateReport report;
  ASSERT_TRUE(
      AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(tumble.samples, states, report).ok());
  EXPECT_FALSE(report.clips_after_compensation);
  ASSERT_TRUE(report.gyro_planes.any_plane_found());
  double known = 0.0;
  for (int i = 0; i < 6; ++i) {
    const int j = i / 2, k = (j + 1 + i % 2) % 3, at = BodyImuConstants::kGyroMisalignmentIndex + i;
    const double sigma = std::sqrt(report.calibration.covariance(at, at));
    EXPECT_LT(std::abs(report.calibration.constants.gyro_misalignment[i] - options.gyro_rows(j, k)), 4.0 * sigma + 1e-3)
        << i;
    known += sigma < 0.005 ? 1.0 : 0.0;
  }
  EXPECT_GE(known, 3.0);
}

TEST(RateElements, AnUprightDeviceIsTakenForOne) {
  const TumbleRecording tumble = make_tumble({});
  std::vector<AngularRateState> states;
  AngularRateReport report;
  ASSERT_TRUE(
      AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(tumble.samples, states, report).ok());
  EXPECT_TRUE(report.clips_after_compensation);
}

// Returns a rate about y that rises and falls linearly and is cut at a level; the level of another element is known.
std::vector<AngularRateObservation> cut_tops(double level_rad_s, double up_rad_s, double down_rad_s, int sign) {
  std::vector<AngularRateObservation> out(60);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double x = static_cast<double>(k) - 30.0;
    const double rate = level_rad_s + 2.0 + (x < 0.0 ? up_rad_s * x : -down_rad_s * x);
    out[k].sample.time_ns = static_cast<TimeNs>(k) * 10'000'000;
    out[k].sample.angular_velocity_rad_s.y() = sign * std::min(level_rad_s, rate);
  }
  return out;
}

SaturationPlanes plane_of_x(double distance_rad_s) {
  SaturationPlanes out;
  out.sensing_axis[0] = SaturationPlane{};
  out.sensing_axis[0]->row = Vector3d::UnitX();
  out.sensing_axis[0]->saturation_limit_rad_s = distance_rad_s;
  out.sensing_axis[0]->samples = {5, 5};
  return out;
}

// The top of the straight lines hides 2 rad/s; whole samples leave half a step uncertain at either end.
TEST(PossibleSaturation, APlateauOfTheMotionNearTheOthersMayHideWhereItsSlopesMeet) {
  for (const int sign : {-1, 1}) {
    for (const double down : {0.25, 0.5}) {
      std::vector<AngularRateObservation> tops = cut_tops(8.5, 0.4, down, sign);
      inflate_covariance_at_plateaus(plane_of_x(8.7), {}, 0.02, 0.005, tops);
      EXPECT_NEAR(2.0 * tops[30].saturation_deficit_sigma_rad_s.y(), 2.0, 0.5 * (0.4 + down)) << down;
      EXPECT_EQ(tops[30].suspected_saturation, 2u);
      EXPECT_EQ(tops[5].suspected_saturation, 0u);
      EXPECT_EQ(tops[30].saturation_deficit_sigma_rad_s.x(), 0.0);
      // neither clipped nor measured, as in the stream
      EXPECT_EQ(rate_source_of(tops[30], {}, Eigen::Matrix3d::Identity()), AngularRateSource::lower_bound_only);
      EXPECT_EQ(rate_source_of(tops[5], {}, Eigen::Matrix3d::Identity()), AngularRateSource::measured);
    }
  }
}

TEST(PossibleSaturation, NothingIsSuspectThatIsKnownOrFarFromTheSaturationLimits) {
  const auto suspect = [](const SaturationPlanes& planes, std::vector<AngularRateObservation> tops) {
    inflate_covariance_at_plateaus(planes, {}, 0.02, 0.005, tops);
    return std::any_of(tops.begin(), tops.end(),
                       [](const AngularRateObservation& o) { return o.suspected_saturation != 0; });
  };
  const std::vector<AngularRateObservation> top = cut_tops(8.5, 0.4, 0.4, 1);
  EXPECT_TRUE(suspect(plane_of_x(8.7), top));
  EXPECT_FALSE(suspect({}, top));
  EXPECT_FALSE(suspect(plane_of_x(9.2), top));  // a saturation limit that differs by 6 % belongs to another element
  SaturationPlanes own = plane_of_x(8.7);
  own.sensing_axis[1] = own.sensing_axis[0];
  EXPECT_FALSE(suspect(own, top));
  std::vector<AngularRateObservation> flagged = top;
  flagged[3].sample.device_clip_flags = 1;
  EXPECT_FALSE(suspect(plane_of_x(8.7), flagged));
}

// With a tilt of 0.06, the level is at least 9.5 - 0.06 * 2 where 9.5 was read with 2 on other axes; 8.5 with 0.5 is at
// most at a level of 8.53.
TEST(PossibleSaturation, WhatWasReadFarBeyondRefutesThem) {
  MinSaturationLevels least;
  least.add({2.0, 9.5, 0.0});
  EXPECT_TRUE(least.is_below_min_saturation_level({0.5, 8.5, 0.0}, 1));
  EXPECT_FALSE(least.is_below_min_saturation_level({0.5, 9.4, 0.0}, 1));
  EXPECT_FALSE(least.is_below_min_saturation_level({13.0, 8.5, 0.0}, 1));  // a tilt makes more of so much motion beside
  EXPECT_FALSE(least.is_below_min_saturation_level({0.5, -8.5, 0.0}, 1));  // nothing was read on that side
  EXPECT_FALSE(least.is_below_min_saturation_level({8.5, 0.5, 0.0}, 0));   // nor of that element

  for (const bool beyond : {false, true}) {
    std::vector<AngularRateObservation> top = cut_tops(8.5, 0.4, 0.4, 1);
    const MinSaturationLevels known = beyond ? least : MinSaturationLevels{};
    inflate_covariance_at_plateaus(plane_of_x(8.7), known, 0.02, 0.005, top);
    EXPECT_EQ(top[30].suspected_saturation != 0, !beyond);
    AngularRateObservation single = top[30];
    single.suspected_saturation = 0;
    inflate_covariance_near_limits(plane_of_x(8.5), known, 0.005, &top[20].sample, single, &top[40].sample);
    EXPECT_EQ(single.rarely_high_axes != 0, !beyond);
  }
}

}  // namespace
}  // namespace tumble
