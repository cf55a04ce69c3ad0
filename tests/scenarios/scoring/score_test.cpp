// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/score.hpp"

#include "scenarios/scoring/binned_metric.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/perfect_estimate.hpp"
#include "tests/scenarios/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {
namespace {

using testing::move_world;
using testing::perfect_estimate;
using testing::scores;
using testing::verdict_of;

Isometry3d turned_world() {
  return Eigen::Translation3d(3.0, -7.0, 2.0) * Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ());
}

Isometry3d tilted_world(double tilt_rad) {
  return Isometry3d(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()));
}

TEST(Metrics, AreNamedByTheirUnitAndDescribed) {
  std::set<std::pair<Kind, std::string>> names;
  ASSERT_GE(metrics().size(), 25u);
  for (const Metric& metric : metrics()) {
    EXPECT_TRUE(names.emplace(metric.kind, metric.info.name).second) << metric.info.name;
    EXPECT_NE(metric.info.doc, "") << metric.info.name;
    const std::string unit = symbol(metric.info.unit);
    std::string ending = unit == "1" ? "" : "_" + unit;
    std::replace(ending.begin(), ending.end(), '/', '_');
    const auto binned = parse_binned(metric.info.name);
    EXPECT_TRUE((binned ? binned->base : metric.info.name).ends_with(ending)) << metric.info.name;
  }
}

TEST(Metrics, OfTheTruthAreZeroWhereverItsWorldStands) {
  const std::set<std::string> shares = {"rate_coverage_3sigma", "rate_coverage_3sigma_flight",
                                        "rate_coverage_3sigma_impact", "map_coverage"};
  for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
    Estimate estimate = perfect_estimate(rig());
    move_world(turned_world(), estimate);
    const auto values = scores(kind, estimate, rig());
    ASSERT_GE(values.size(), 4u) << to_string(kind);
    for (const auto& [name, value] : values) {
      if (name == "map_unique_share") continue;  // at rest every sweep truly hits the same points
      EXPECT_NEAR(value, shares.contains(name) ? 1.0 : 0.0, 1e-9) << name;  // rounding, interpolation of the truth
    }
    EXPECT_EQ(verdict_of(kind, estimate, rig()), OutcomeStatus::ok);
  }
}

TEST(RateScores, AnOffsetIsItsOwnError) {
  Estimate estimate = perfect_estimate(rig());
  const ClippingTruth truth(rig().sensors, rig().truth);
  for (std::size_t k = 0; k < estimate.rates.size(); ++k) {
    const double error = truth.clipped_axes(k) ? 5.0 : 0.5;
    estimate.rates[k].w_WI_I_rad_s += error * Vector3d(0.6, 0.0, 0.8);
  }
  const auto values = scores(Kind::rate, estimate, rig());
  EXPECT_NEAR(values.at("rate_error_clipped_median_rad_s"), 5.0, 1e-12);
  EXPECT_NEAR(values.at("rate_error_clipped_p99_rad_s"), 5.0, 1e-12);
  EXPECT_NEAR(values.at("rate_error_free_median_rad_s"), 0.5, 1e-12);
}

// The error of the clipped gyro is the amount by which the rate exceeds the range.
TEST(RateScores, AnErrorIsDividedByTheRateBeyondTheRange) {
  const sim::ImuRecord& imu = rig().sensors.imus.front();
  const sim::ImuTruth& known = rig().truth.imus.front();
  const ClippingTruth truth(rig().sensors, rig().truth);
  Estimate gyro = perfect_estimate(rig()), partly = gyro;
  for (std::size_t k = 0; k < gyro.rates.size(); ++k) {
    gyro.rates[k].w_WI_I_rad_s = imu.gyro_rad_s[k];
    const double beyond_rad_s = (known.gyro_unclipped_rad_s[k] - imu.gyro_rad_s[k]).norm();
    const bool clipped = truth.clipped_axes(k) != 0;  // the error of an unclipped sample must not count
    partly.rates[k].w_WI_I_rad_s.y() += clipped ? (k % 3 == 0 ? 5.0 : 0.02) * beyond_rad_s : 100.0;
  }
  EXPECT_NEAR(scores(Kind::rate, gyro, rig()).at("rate_error_beyond_range_share"), 1.0, 1e-9);
  EXPECT_NEAR(scores(Kind::rate, partly, rig()).at("rate_error_beyond_range_share"), 0.02, 1e-9);
}

TEST(RateScores, ASegmentIsJudgedByItsMeanAndTheWorstSampleByItself) {
  Estimate alternating = perfect_estimate(rig()), offset = alternating;
  const ClippingTruth truth(rig().sensors, rig().truth);
  for (std::size_t k = 0; k < alternating.rates.size(); ++k) {
    if (truth.clipped_axes(k) == 0) continue;
    alternating.rates[k].w_WI_I_rad_s.x() += k % 2 == 0 ? 2.0 : -2.0;
    offset.rates[k].w_WI_I_rad_s.x() += 2.0;
  }
  const auto wild = scores(Kind::rate, alternating, rig()), shifted = scores(Kind::rate, offset, rig());
  EXPECT_NEAR(wild.at("rate_error_clipped_max_rad_s"), 2.0, 1e-12);
  EXPECT_LT(wild.at("rate_error_segment_max_rad_s"), 0.1);  // one sample more with this sign, of at least twenty
  EXPECT_NEAR(shifted.at("rate_error_segment_max_rad_s"), 2.0, 1e-12);
}

TEST(RateScores, CoverageAndNormalisedErrorApartForFlightAndContact) {
  sim::Recording recording = rig();
  const std::size_t half = recording.truth.label.size() / 2;
  for (std::size_t k = half; k < recording.truth.label.size(); ++k) recording.truth.label[k] = sim::ContactLabel::grip;
  const std::int64_t border_ns = static_cast<std::int64_t>(half) * recording.truth.period_ns;
  Estimate estimate = perfect_estimate(recording);
  for (AngularRateState& rate : estimate.rates) {
    rate.covariance_rad2_s2 = 0.01 * Eigen::Matrix3d::Identity();
    rate.w_WI_I_rad_s += Eigen::Vector3d::Constant(rate.time_ns < border_ns ? 0.1 : 0.4);
  }
  const auto values = scores(Kind::rate, estimate, recording);
  EXPECT_EQ(values.at("rate_coverage_3sigma_flight"), 1.0);
  EXPECT_EQ(values.at("rate_coverage_3sigma_impact"), 0.0);
  EXPECT_NEAR(values.at("rate_nees_flight"), 1.0, 1e-9);
  EXPECT_NEAR(values.at("rate_nees_impact"), 16.0, 1e-9);
}

TEST(RateScores, CoverageCountsClippedAxesWithinThreeSigma) {
  Estimate estimate = perfect_estimate(rig());
  const ClippingTruth truth(rig().sensors, rig().truth);
  int total = 0;
  int within = 0;
  for (std::size_t k = 0; k < estimate.rates.size(); ++k) {
    estimate.rates[k].covariance_rad2_s2 = 0.04 * Eigen::Matrix3d::Identity();
    for (int j = 0; j < 3; ++j) {
      const bool far = k % 3 == 0;
      // an error on an unsaturated axis must not count
      estimate.rates[k].w_WI_I_rad_s[j] += truth.clipped_axes(k) >> j & 1 ? (far ? 0.61 : 0.59) : 100.0;
      if (!(truth.clipped_axes(k) >> j & 1)) continue;
      total += 1;
      within += far ? 0 : 1;
    }
  }
  ASSERT_GT(total, 50);
  EXPECT_NEAR(scores(Kind::rate, estimate, rig()).at("rate_coverage_3sigma"), static_cast<double>(within) / total,
              1e-15);
}

// If a method shortens or drops the last sweep, the scoring compares all methods at the previous sweep.
TEST(EndPose, EveryMethodEndsAtTheLastSweepThatTheImuCovers) {
  sim::Recording recording = rig();
  sim::ImuRecord& imu = recording.sensors.imus.front();
  const std::int64_t end_ns = imu.time_ns.back() - 10'000'000;
  while (imu.time_ns.back() > end_ns) imu.time_ns.pop_back(), imu.gyro_rad_s.pop_back(), imu.accel_m_s2.pop_back();
  Estimate shortened = perfect_estimate(rig());
  PoseState& last = shortened.sweeps.back().pose;
  last.time_ns = end_ns;
  last.position_W_m.x() += 1.0;
  Estimate dropped = perfect_estimate(rig());
  dropped.sweeps.pop_back();
  for (const Estimate& estimate : {shortened, dropped})
    EXPECT_NEAR(scores(Kind::slam, estimate, recording).at("translation_error_end_m"), 0.0, 1e-6);
}

TEST(RateScores, WithoutClippingThereIsNothingToScoreClipped) {
  testing::SyntheticMotion motion;
  motion.rail_rad_s = 50.0;
  const sim::Recording recording = testing::synthetic_rig(motion);
  const auto values = scores(Kind::rate, perfect_estimate(recording), recording);
  EXPECT_FALSE(values.contains("rate_error_clipped_median_rad_s"));
  EXPECT_FALSE(values.contains("rate_error_beyond_range_share"));
  EXPECT_FALSE(values.contains("rate_coverage_3sigma"));
  EXPECT_TRUE(values.contains("rate_error_free_median_rad_s"));
}

TEST(RateScores, OneNaNSpoilsTheFigure) {
  Estimate estimate = perfect_estimate(rig());
  estimate.rates[600].w_WI_I_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(scores(Kind::rate, estimate, rig()).at("rate_error_clipped_median_rad_s")));
  EXPECT_EQ(verdict_of(Kind::rate, estimate, rig()), OutcomeStatus::diverged);
}

TEST(AttitudeScores, SplitTheErrorAsBroadDoes) {
  // the error is a rotation about z (heading), followed by a tilt about a horizontal axis (inclination)
  const double tilt = 0.1;
  const double yaw = 0.3;
  Estimate estimate = perfect_estimate(rig());
  for (std::size_t k = 1; k < estimate.attitudes.size(); ++k) {
    estimate.attitudes[k].orientation_W = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()) *
                                          Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                          estimate.attitudes[k].orientation_W;
  }
  const auto values = scores(Kind::attitude, estimate, rig());
  EXPECT_NEAR(values.at("inclination_rmse_rad"), tilt, 1e-9);
  EXPECT_NEAR(values.at("heading_rmse_rad"), yaw, 1e-9);
  EXPECT_NEAR(values.at("attitude_rmse_rad"), 2.0 * std::acos(std::cos(tilt / 2) * std::cos(yaw / 2)), 1e-9);
}

TEST(AttitudeScores, AHeadingAtTheStartIsRemovedATiltIsNot) {
  Estimate estimate = perfect_estimate(rig());
  move_world(tilted_world(0.05), estimate);
  const auto values = scores(Kind::attitude, estimate, rig());
  EXPECT_NEAR(values.at("inclination_rmse_rad"), 0.05, 1e-9);
}

TEST(PositionScores, AGrowingOffsetGivesKnownErrors) {
  Estimate estimate = perfect_estimate(rig(), Frame::body);
  const Vector3d start = estimate.poses.front().position_W_m;
  for (PoseState& pose : estimate.poses) pose.position_W_m = start + 1.1 * (pose.position_W_m - start);
  const testing::SyntheticMotion motion;
  const double length = motion.displacement_m.norm();
  const auto values = scores(Kind::position, estimate, rig());
  EXPECT_NEAR(values.at("position_end_error_m"), 0.1 * length, 1e-9);
  EXPECT_NEAR(values.at("position_end_error_share"), 0.1, 1e-9);
  EXPECT_NEAR(values.at("position_height_error_max_m"), 0.1 * motion.displacement_m.z(), 1e-9);
  EXPECT_NEAR(values.at("rpe_1m_m"), 0.1, 1e-3);  // segments end at the first sample beyond the metre
  EXPECT_NEAR(values.at("rpe_1m_rad"), 0.0, 1e-9);
}

TEST(PositionScores, TheShareIsOfTheSamePathInEveryFrame) {
  // the offset is 5 cm at the end, both for a point that rotates about the centre of mass and for the centre
  const auto share_in = [](Frame frame) {
    Estimate estimate = perfect_estimate(rig(), frame);
    estimate.poses.back().position_W_m.x() += 0.05;
    return scores(Kind::position, estimate, rig()).at("position_end_error_share");
  };
  EXPECT_NEAR(share_in(Frame::body), 0.05 / testing::SyntheticMotion().displacement_m.norm(), 1e-6);
  EXPECT_NEAR(share_in(Frame::imu), share_in(Frame::body), 1e-6);
}

TEST(PositionScores, CoverageCountsErrorsWithinThreeSigmas) {
  Estimate estimate = perfect_estimate(rig(), Frame::body);
  EXPECT_FALSE(scores(Kind::position, estimate, rig()).contains("position_coverage_3sigma")) << "nothing is stated";
  const std::size_t half = estimate.poses.size() / 2;
  for (std::size_t k = 0; k < estimate.poses.size(); ++k) {
    estimate.poses[k].covariance.diagonal().head<3>().setConstant(0.01 * 0.01);
    if (k > 0) estimate.poses[k].position_W_m.x() += 0.029;  // the first pose aligns both trajectories
  }
  EXPECT_EQ(scores(Kind::position, estimate, rig()).at("position_coverage_3sigma"), 1.0);
  for (std::size_t k = 1; k < estimate.poses.size(); ++k) estimate.poses[k].position_W_m.x() += 0.002;
  EXPECT_NEAR(scores(Kind::position, estimate, rig()).at("position_coverage_3sigma"), 2.0 / 3.0, 1e-12);
  for (std::size_t k = half; k < estimate.poses.size(); ++k) estimate.poses[k].position_W_m.y() += 1.0;
  EXPECT_LT(scores(Kind::position, estimate, rig()).at("position_coverage_3sigma"), 0.66);
}

TEST(PositionScores, TheNormalisedErrorSeesACovarianceThatIsHalved) {
  Estimate estimate = perfect_estimate(rig(), Frame::body);
  EXPECT_FALSE(scores(Kind::position, estimate, rig()).contains("position_nees_median")) << "nothing is stated";
  for (std::size_t k = 1; k < estimate.poses.size(); ++k) estimate.poses[k].position_W_m.array() += 0.01;
  for (const double variance_m2 : {4e-4, 2e-4}) {
    for (PoseState& pose : estimate.poses) pose.covariance.diagonal().head<3>().setConstant(variance_m2);
    // the median square of a standard normal variable is 0.4549
    EXPECT_NEAR(scores(Kind::position, estimate, rig()).at("position_nees_median"), 1e-4 / variance_m2 / 0.454936,
                1e-9);
  }
}

TEST(AttitudeScores, TheTiltIsComparedWithItsCovarianceForAnyHeading) {
  constexpr double kTilt = 0.02;
  Estimate estimate = perfect_estimate(rig());
  EXPECT_FALSE(scores(Kind::attitude, estimate, rig()).contains("inclination_nees_median")) << "nothing is stated";
  for (AttitudeState& attitude : estimate.attitudes) {
    // q_true = Exp(phi) q, with phi about x and y of the estimate's world frame, which is rotated about the vertical
    const Quaterniond tilt(Eigen::AngleAxisd(kTilt, Vector3d(1.0, 1.0, 0.0).normalized()));
    attitude.orientation_W =
        tilt.conjugate() * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()) * attitude.orientation_W;
  }
  const double square = kTilt * kTilt / 2.0;
  for (const double variance : {4.0 * square, 2.0 * square, square / 8.0, square / 10.0}) {
    for (AttitudeState& attitude : estimate.attitudes) attitude.covariance_rad2.diagonal().setConstant(variance);
    const auto values = scores(Kind::attitude, estimate, rig());
    EXPECT_NEAR(values.at("inclination_nees_median"), square / variance / 0.454936, 1e-6);
    EXPECT_EQ(values.at("inclination_coverage_3sigma"), square <= 9.0 * variance ? 1.0 : 0.0);
  }
}

TEST(TrajectoryScores, AteIsTheRmsOfAConstantShift) {
  Estimate estimate = perfect_estimate(rig());
  for (std::size_t k = 1; k < estimate.poses.size(); ++k) estimate.poses[k].position_W_m += Vector3d(0.3, 0.4, 0.0);
  const double n = static_cast<double>(estimate.poses.size());
  EXPECT_NEAR(scores(Kind::slam, estimate, rig()).at("ate_m"), 0.5 * std::sqrt((n - 1.0) / n), 1e-9);
}

TEST(TrajectoryScores, AteOfTheRotationIsTheRmsOfAConstantTurn) {
  Estimate estimate = perfect_estimate(rig());
  const Quaterniond turn(Eigen::AngleAxisd(0.2, Vector3d(1, 2, 2) / 3.0));
  for (std::size_t k = 1; k < estimate.poses.size(); ++k)
    estimate.poses[k].orientation_W = estimate.poses[k].orientation_W * turn;
  const double n = static_cast<double>(estimate.poses.size());
  const auto values = scores(Kind::slam, estimate, rig());
  EXPECT_NEAR(values.at("ate_rad"), 0.2 * std::sqrt((n - 1.0) / n), 1e-9);
  EXPECT_NEAR(values.at("ate_m"), 0.0, 1e-9);
}

TEST(TrajectoryScores, ATiltedStartIsAnError) {
  Estimate estimate = perfect_estimate(rig(), Frame::body);
  move_world(tilted_world(0.02), estimate);
  const testing::SyntheticMotion motion;
  // the path is turned about x by 0.02 rad: its end moves by 2 sin(0.01) times its component perpendicular to x
  const double across = std::hypot(motion.displacement_m.y(), motion.displacement_m.z());
  EXPECT_NEAR(scores(Kind::position, estimate, rig()).at("position_end_error_m"), 2.0 * std::sin(0.01) * across, 1e-9);
}

TEST(EndPoseScores, CountFromTheSixthRegisteredSweep) {
  Estimate estimate = perfect_estimate(rig());
  // the sweeps are wrong until the fifth and right from the sixth on, so the error is zero
  for (std::size_t k = 0; k < 5; ++k) estimate.sweeps[k].pose.position_W_m += Vector3d(1, 1, 1);
  EXPECT_NEAR(scores(Kind::slam, estimate, rig()).at("translation_error_end_m"), 0.0, 1e-9);
  estimate.sweeps[2].verdict = SweepVerdict::rejected;
  estimate.sweeps[5].pose.position_W_m += Vector3d(1, 1, 1);
  EXPECT_NEAR(scores(Kind::slam, estimate, rig()).at("translation_error_end_m"), 0.0, 1e-9);
  estimate.sweeps.back().verdict = SweepVerdict::rejected;  // the last sweep counts even if it is rejected
  estimate.sweeps.back().pose.position_W_m += Vector3d(0.0, 0.0, 0.25);
  estimate.sweeps.back().pose.orientation_W =
      Eigen::AngleAxisd(2.8, Eigen::Vector3d::UnitY()) * estimate.sweeps.back().pose.orientation_W;
  const auto values = scores(Kind::slam, estimate, rig());
  EXPECT_NEAR(values.at("translation_error_end_m"), 0.25, 1e-9);
  EXPECT_NEAR(values.at("rotation_error_end_rad"), 2.8, 1e-9);  // a clamped arccos would give at most 90 degrees
}

TEST(EndPoseScores, FewerThanSixSweepsAreADivergence) {
  Estimate estimate = perfect_estimate(rig());
  for (std::size_t k = 5; k < estimate.sweeps.size(); ++k) estimate.sweeps[k].verdict = SweepVerdict::rejected;
  EXPECT_FALSE(scores(Kind::slam, estimate, rig()).contains("translation_error_end_m"));
  EXPECT_EQ(verdict_of(Kind::slam, estimate, rig()), OutcomeStatus::diverged);
}

TEST(SweepBorderScores, AJumpAtEveryBorderIsFound) {
  Estimate estimate = perfect_estimate(rig());
  for (std::size_t k = 1; k < estimate.sweeps.size(); k += 2) {
    for (PoseState& pose : estimate.sweeps[k].trajectory) pose.velocity_W_m_s += Vector3d(0.0, 0.3, 0.4);
  }
  const auto values = scores(Kind::slam, estimate, rig());
  EXPECT_NEAR(values.at("sweep_jump_m_s"), 0.5, 1e-9);
}

TEST(Verdict, AnEndFartherThanThePathIsADivergence) {
  for (const Kind kind : {Kind::position, Kind::slam}) {
    Estimate estimate = perfect_estimate(rig(), Frame::body);
    const double length = testing::SyntheticMotion().displacement_m.norm();
    estimate.poses.back().position_W_m.x() += 0.9 * length;
    EXPECT_EQ(verdict_of(kind, estimate, rig()), OutcomeStatus::ok);
    estimate.poses.back().position_W_m.x() += 0.2 * length;
    EXPECT_EQ(verdict_of(kind, estimate, rig()), OutcomeStatus::diverged);
  }
}

TEST(Verdict, NumbersThatAreNotFiniteAreADivergence) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Estimate attitude = perfect_estimate(rig());
  attitude.attitudes[100].orientation_W.x() = nan;
  EXPECT_EQ(verdict_of(Kind::attitude, attitude, rig()), OutcomeStatus::diverged);
  Estimate position = perfect_estimate(rig());
  position.poses[100].position_W_m.z() = nan;
  EXPECT_EQ(verdict_of(Kind::position, position, rig()), OutcomeStatus::diverged);
}

TEST(Verdict, AnEstimateThatStopsOrAnswersHalfIsADivergence) {
  Estimate stopped = perfect_estimate(rig());
  stopped.poses.resize(stopped.poses.size() / 2);
  stopped.attitudes.resize(stopped.attitudes.size() / 2);
  EXPECT_EQ(verdict_of(Kind::position, stopped, rig()), OutcomeStatus::diverged);
  EXPECT_EQ(verdict_of(Kind::attitude, stopped, rig()), OutcomeStatus::diverged);
  Estimate picked = perfect_estimate(rig());
  const ClippingTruth truth(rig().sensors, rig().truth);
  std::erase_if(picked.rates, [&](const AngularRateState& rate) { return truth.at(rate.time_ns)->clipped_axes != 0; });
  EXPECT_EQ(verdict_of(Kind::rate, picked, rig()), OutcomeStatus::diverged);
  EXPECT_EQ(verdict_of(Kind::rate, Estimate{}, rig()), OutcomeStatus::diverged);
}

// The time before a late start of lidar or IMU does not count as a gap in the estimate.
TEST(Verdict, TheTimeBeforeTheSensorsStartIsNoHole) {
  sim::Recording late = rig();
  const std::int64_t start_ns = late.sensors.imus.front().time_ns.back() * 2 / 5;
  Estimate estimate = perfect_estimate(rig(), Frame::body);
  std::erase_if(estimate.poses, [&](const PoseState& pose) { return pose.time_ns < start_ns; });
  EXPECT_EQ(verdict_of(Kind::slam, estimate, late), OutcomeStatus::diverged);
  for (std::int64_t& sweep_ns : late.sensors.lidars.front().sweep_start_ns) sweep_ns = std::max(sweep_ns, start_ns);
  EXPECT_EQ(verdict_of(Kind::slam, estimate, late), OutcomeStatus::ok);
  EXPECT_EQ(verdict_of(Kind::position, estimate, late), OutcomeStatus::diverged) << "the IMU starts on time";
  late.sensors.imus.front().time_ns.front() = start_ns;
  EXPECT_EQ(verdict_of(Kind::position, estimate, late), OutcomeStatus::ok);
}

TEST(Score, NeedsTheTruth) {
  EXPECT_THROW(score(Kind::rate, {Estimate{}, ScoringInput{&rig().sensors, nullptr, nullptr}}), BadInput);
  EXPECT_THROW(verdict(Kind::rate, {Estimate{}, ScoringInput{nullptr, &rig().truth, nullptr}}), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
