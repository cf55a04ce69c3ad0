// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/scenarios/methods/rates_without_suspect_terms.hpp"
#include "tests/scenarios/methods/wrong_inputs.hpp"
#include "tests/scenarios/testing.hpp"

// the test checks what methods report when their inputs are wrong; tests/bench/verdicts has the figures over many draws
namespace tumble::scenarios {
namespace {

/// Returns a method's estimate on a draw with wrong inputs.
Estimate run_wrong(const SimulatedDraw& draw, const char* method, const std::string& wrong) {
  SimulatedDraw given = draw;
  testing::wrong_inputs().at(wrong)(given.recording.sensors);
  Outcome outcome;
  return run_method(*find_methods(method).at(0), given, outcome);
}

/// Returns a draw without lidar data. Several tests share a draw, which is simulated once.
const SimulatedDraw& imu_draw(const std::string& scenario, std::uint64_t seed) {
  static std::map<std::pair<std::string, std::uint64_t>, SimulatedDraw> draws;
  const auto found = draws.find({scenario, seed});
  if (found != draws.end()) return found->second;
  const DataRoot data{test::source_dir()};
  SimulatedDraw draw = simulate_draw(data, load_scenario(data, scenario), seed, 1, Lidars::left_out);
  return draws.emplace(std::pair(scenario, seed), std::move(draw)).first->second;
}

struct Said {
  OutcomeStatus status;
  bool consistent = false;
  double ate_m = std::nan(""), nees = std::nan("");
};

Said said_of(const Method& method, const SimulatedDraw& draw, const std::string& wrong) {
  SimulatedDraw given = draw;
  testing::wrong_inputs().at(wrong)(given.recording.sensors);
  Outcome outcome;
  const Estimate estimate = run_method(method, given, outcome);
  Said out{outcome.status};
  if (outcome.status != OutcomeStatus::ok) return out;
  EXPECT_FALSE(estimate.health.contains("localised")) << "no prior map";
  out.consistent = has_consistent_poses(estimate);
  assess(method, scored_by(draw, given), nullptr, estimate, outcome);
  for (const Score& score : outcome.scores) {
    if (score.metric == "ate_m") out.ate_m = score.value;
    if (score.metric == "pose_nees") out.nees = score.value;
  }
  return out;
}

/// slam/tumble must correct the `harmless` wrong inputs, and must report the `harmful` wrong inputs.
void expect_slam_verdicts(const std::vector<std::string>& harmless, const std::vector<std::string>& harmful) {
  const DataRoot data{test::source_dir()};
  const SimulatedDraw draw = simulate_draw(data, load_scenario(data, "hill"), 16202, 1);
  const Method& method = *find_methods("slam/tumble").at(0);
  for (const std::string& wrong : harmless) {
    const Said good = said_of(method, draw, wrong);
    EXPECT_TRUE(good.consistent) << wrong;
    EXPECT_LT(good.ate_m, 0.06) << wrong;
    EXPECT_LT(good.nees, 3.0) << wrong;
  }
  for (const std::string& wrong : harmful) {
    const Said bad = said_of(method, draw, wrong);
    EXPECT_TRUE(bad.status != OutcomeStatus::ok || !bad.consistent) << wrong;
    EXPECT_FALSE(bad.ate_m < 0.2) << wrong;  // control: the wrong input causes an error
  }
}

// the mounting is wrong by 3 deg and 3 cm; the method estimates this error
TEST(Verdicts, SlamFindsAWrongCalibrationAndSaysWhenSensorsContradictEachOther) {
  expect_slam_verdicts({"none", "mounting_2_deg"}, {"accel_flipped"});
}

// the clocks differ by 20 ms, which the method estimates
TEST(VerdictsSoak, SlamFindsAWrongClockAndFurtherContradictionsOfSensors) {
  expect_slam_verdicts({"lidar_20_ms"}, {"gyro_x_y_swapped", "lidar_ranges_long"});
}

// The test checks the method with a lag, which uses only past samples. TumblingOdometry::health() reports the same
// finding.
TEST(Verdicts, SlamThatLagsFindsALidarOfAnotherScale) {
  const DataRoot data{test::source_dir()};
  const SimulatedDraw draw = simulate_draw(data, load_scenario(data, "hill"), 62022, 1);
  const Method& method = *find_methods("slam/tumble_lag").at(0);
  EXPECT_TRUE(said_of(method, draw, "none").consistent);
  EXPECT_FALSE(said_of(method, draw, "lidar_ranges_long").consistent);
}

// A person moves the rig slowly, so velocity and rotation change little.
TEST(VerdictsSoak, SlamThatLagsFindsFaultsInSlowMotion) {
  const DataRoot data{test::source_dir()};
  const SimulatedDraw draw = simulate_draw(data, load_scenario(data, "stroll"), 650001, 1);
  const auto says = [&](const char* wrong) { return run_wrong(draw, "slam/tumble_lag", wrong).faults; };
  EXPECT_FALSE(says("none").invalidates_estimate());
  for (const char* wrong : {"lidar_ranges_long", "lidar_times_reversed"})
    EXPECT_TRUE(says(wrong).invalidates_estimate()) << wrong;
}

// The IMU starts during the motion. At the end of the run, pushes tilt the force while the rig rocks.
TEST(Verdicts, AZeroOffsetOfAGyroThatStartsLateIsNoFault) {
  const SimulatedDraw& draw = imu_draw("hill", 1001);
  for (const char* wrong : {"gyros_late_offset_5_deg_s", "gyros_late_offset_8_deg_s"}) {
    const Estimate estimate = run_wrong(draw, "rate/tumble", wrong);
    EXPECT_TRUE(estimate.faults.ok()) << estimate.faults.worst_message();
  }
  EXPECT_TRUE(has_implausible_readings(run_wrong(draw, "rate/tumble", "gyro_halved")));
}

// The method corrects a part of a mounting error of 10 deg, and the final position is wrong by 0.7 m. The size of the
// correction reveals the fault.
TEST(Verdicts, SlamLiveReportsAMountingThatDiffersFromTheGivenOne) {
  const DataRoot data{test::source_dir()};
  const SimulatedDraw draw = simulate_draw(data, load_scenario(data, "throw"), 87201, 1);
  const Method& method = *find_methods("slam/tumble_live").at(0);
  EXPECT_TRUE(said_of(method, draw, "none").consistent);
  const Said moved = said_of(method, draw, "mounting_10_deg");
  EXPECT_FALSE(moved.consistent);
  EXPECT_GT(moved.ate_m, 0.3) << "nothing was wrong";
}

// If all gyros have the same wrong scale, the scale correction of the filter makes the path wrong by more than a metre.
// The forces of IMUs at different positions reveal the wrong gyro scale.
TEST(Verdicts, PositionReportsGyrosOfAnotherScale) {
  const SimulatedDraw& draw = imu_draw("slip", 16202);
  const auto tells = [&](const std::string& wrong) {
    const Estimate estimate = run_wrong(draw, "position/tumble", wrong);
    return !estimate.status.ok() || estimate.health.contains("imu_implausible");
  };
  EXPECT_FALSE(tells("none"));
  EXPECT_TRUE(tells("gyro_scale_5_percent"));
  EXPECT_TRUE(tells("all_gyros_frozen"));
}

// In the first case, one axis is flipped, and its force component is too small for the other checks. In the second
// case, all accelerometers are frozen, and the method rejects the run.
TEST(Verdicts, PositionReportsAFlippedAxisAndRefusesForcesThatAllFroze) {
  const SimulatedDraw& draw = imu_draw("slide", 99453);
  const Estimate good = run_wrong(draw, "position/tumble", "none");
  EXPECT_TRUE(good.faults.ok()) << good.faults.worst_message();
  const Estimate flipped = run_wrong(draw, "position/tumble", "gyro_x_flipped");
  EXPECT_TRUE(has_implausible_readings(flipped));
  ASSERT_TRUE(has_finding(HealthFinding::Kind::wrong_axes_or_signs, flipped));
  EXPECT_EQ(run_wrong(draw, "position/tumble", "all_accels_frozen").status.error_code, ErrorCode::out_of_range);
}

// In this draw, the force differences between the IMUs are 6 to 9 % too small, because of errors in the IMU positions.
// The rotation of gravity confirms the gyros.
TEST(Verdicts, PositionDoesNotBlameGyrosForPlaces) {
  const SimulatedDraw& draw = imu_draw("bump", 99470);
  const Estimate good = run_wrong(draw, "position/tumble", "none");
  EXPECT_GT(std::abs(good.health.at("lever_arm_agreement") - 1.0), 0.06);
  EXPECT_TRUE(good.faults.ok()) << good.faults.worst_message();
  EXPECT_TRUE(has_finding(HealthFinding::Kind::gyro_scale, run_wrong(draw, "position/tumble", "gyro_scale_5_percent")));
}

TEST(Verdicts, PositionDivergesWithForcesOfHalfTheSize) {
  SimulatedDraw draw = imu_draw("roll", 16202);
  testing::wrong_inputs().at("accel_halved")(draw.recording.sensors);
  const Method& method = *find_methods("position/tumble").at(0);
  Outcome outcome;
  const Estimate estimate = run_method(method, draw, outcome);
  assess(method, draw, nullptr, estimate, outcome);
  EXPECT_EQ(outcome.status, OutcomeStatus::diverged);
  EXPECT_TRUE(has_finding(HealthFinding::Kind::wrong_force_magnitude_at_rest, estimate));
  EXPECT_EQ(estimate.health.at("imu_implausible"), 1.0);
  EXPECT_NEAR(estimate.faults.worst_status().value, 0.5, 0.02);
}

// The time stamps are in microseconds instead of nanoseconds, so the whole run lasts only some milliseconds.
TEST(Verdicts, StampsOfAnotherUnitThanThePeriodAreRefused) {
  SimulatedDraw draw = imu_draw("hill", 62001);
  testing::wrong_inputs().at("stamps_in_us")(draw.recording.sensors);
  for (const char* method : {"rate/tumble", "rate/tumble_lag", "attitude/tumble"}) {
    Outcome outcome;
    const Estimate estimate = run_method(*find_methods(method).at(0), draw, outcome);
    EXPECT_EQ(estimate.status.error_code, ErrorCode::out_of_range) << method;
    EXPECT_NE(std::string(estimate.status.field).find("period"), std::string::npos) << method;
  }
}

// The rotation from one rest to the next must be consistent with gravity. The methods for attitude test this too.
TEST(Verdicts, AttitudesTellWrongReadingsOfATumble) {
  const SimulatedDraw& draw = imu_draw("hill", 91001);
  const auto tells = [&](const char* method, const std::string& wrong) {
    const Estimate estimate = run_wrong(draw, method, wrong);
    return !estimate.status.ok() || estimate.health.contains("imu_implausible");
  };
  EXPECT_FALSE(tells("attitude/tumble", "none"));
  for (const char* wrong :
       {"gyro_zero", "gyro_flipped", "gyro_halved", "gyro_x_y_swapped", "accel_without_gravity", "accel_x_y_swapped"})
    EXPECT_TRUE(tells("attitude/tumble", wrong)) << wrong;
  EXPECT_FALSE(tells("attitude/tumble_batch", "none"));
  EXPECT_TRUE(tells("attitude/tumble_batch", "gyro_zero")) << "it makes the turning up itself";
}

struct SaidOfRates {
  bool implausible = false, z_frozen = false, mislabelled_axes = false;
  double turned_sigma_rad_s = 0.0;  ///< mean while it rotates
};

SaidOfRates rates_of(const SimulatedDraw& draw, const std::string& wrong) {
  const Estimate estimate = run_wrong(draw, "rate/tumble", wrong);
  SaidOfRates out{estimate.health.contains("imu_implausible"), has_finding(HealthFinding::Kind::frozen_axis, estimate),
                  has_finding(HealthFinding::Kind::inverted_accel_in_flight, estimate)};
  double samples = 0.0;
  for (const AngularRateState& rate : estimate.rates) {
    if (rate.w_WI_I_rad_s.norm() < 2.0) continue;
    out.turned_sigma_rad_s += std::sqrt(rate.covariance_rad2_s2.trace());
    samples += 1.0;
  }
  out.turned_sigma_rad_s /= samples;
  return out;
}

// The tumble contains flights, impacts and saturated axes. Gravity at the rests before and after the tumble reveals
// wrong rates.
TEST(Verdicts, RatesTellAGyroOfAnotherSenseAndAnAxisThatFroze) {
  const SimulatedDraw& draw = imu_draw("hill", 62001);
  const SaidOfRates good = rates_of(draw, "none");
  EXPECT_FALSE(good.implausible);
  EXPECT_FALSE(good.z_frozen);
  EXPECT_FALSE(good.mislabelled_axes);
  // with an inverted accelerometer, gravity rotates as the gyro measures, and only the flight reveals the fault
  const SaidOfRates mirrored = rates_of(draw, "accel_flipped");
  EXPECT_TRUE(mirrored.implausible);
  EXPECT_TRUE(mirrored.mislabelled_axes);
  const SaidOfRates flipped = rates_of(draw, "gyro_flipped");
  EXPECT_TRUE(flipped.implausible);
  EXPECT_GT(flipped.turned_sigma_rad_s, 2.0) << "and does not state to know them";
  const SaidOfRates frozen = rates_of(draw, "gyro_z_frozen");
  EXPECT_TRUE(frozen.implausible);
  EXPECT_TRUE(frozen.z_frozen);
}

// The gyro is saturated in every flight of this draw, so the check must also use saturated readings:
// docs/maths/imu_merge.md (I32).
TEST(Verdicts, FlightsTellInvertedForcesWhileTheGyroClips) {
  const SimulatedDraw& draw = imu_draw("throw", 99101);
  EXPECT_FALSE(rates_of(draw, "none").mislabelled_axes);
  for (const char* wrong : {"accel_flipped", "accel_z_flipped"})
    EXPECT_TRUE(rates_of(draw, wrong).mislabelled_axes) << wrong;
}

// After a gap in a tumble, the attitude is wrong by radians, and the covariance must include this error: attitude.md
// (A17).
TEST(Verdicts, AttitudesSayThatAGapLeavesThemWithoutUp) {
  const SimulatedDraw& draw = imu_draw("hill", 99101);
  EXPECT_FALSE(has_finding(HealthFinding::Kind::attitude_unknown, run_wrong(draw, "attitude/tumble", "none")));
  const Estimate estimate = run_wrong(draw, "attitude/tumble", "imus_silent_300_ms");
  EXPECT_TRUE(has_finding(HealthFinding::Kind::attitude_unknown, estimate));
  const TruthTrack truth(draw.recording.truth, estimate.frame);
  double beyond = 0.0;
  for (const AttitudeState& attitude : estimate.attitudes) {
    const Eigen::Vector2d off = tilt_error_rad(attitude.orientation_W, truth.pose(attitude.time_ns).orientation_W);
    beyond += off.norm() > 3.0 * std::sqrt(attitude.covariance_rad2.topLeftCorner<2, 2>().trace()) ? 1.0 : 0.0;
  }
  // without a bridged gap, nine of ten moving samples exceed the bound
  EXPECT_LT(beyond, 0.01 * static_cast<double>(estimate.attitudes.size()));
}

// The wand never rests, so no window of constant force reveals the fault.
TEST(Verdicts, RatesTellAWandWhoseGyroIsNamedOrScaledOtherwise) {
  const SimulatedDraw& draw = imu_draw("twirl", 81201);
  EXPECT_FALSE(rates_of(draw, "none").implausible);
  EXPECT_TRUE(rates_of(draw, "gyro_z_flipped").implausible) << "about which it hardly turns";
  EXPECT_TRUE(rates_of(draw, "gyro_scale_5_percent").implausible);
}

// The methods for attitude check the gyro in the same way as the methods for rates.
TEST(Verdicts, AttitudesTellAWandWhoseGyroIsNamedOtherwise) {
  const SimulatedDraw& draw = imu_draw("twirl", 81201);
  const auto tells = [&](const char* method, const char* wrong) {
    const Estimate estimate = run_wrong(draw, method, wrong);
    return estimate.health.contains("imu_implausible");
  };
  EXPECT_FALSE(tells("attitude/tumble", "none"));
  EXPECT_TRUE(tells("attitude/tumble", "gyro_z_flipped")) << "about which it hardly turns";
  EXPECT_TRUE(tells("attitude/tumble_batch", "gyro_z_flipped"));
}

// The scoring uses the covariances from before the findings increased them.
TEST(Verdicts, CovariancesWithoutSuspectTermsAreRestored) {
  const SimulatedDraw& draw = imu_draw("hill", 62001);
  const auto trace = [](const std::vector<AngularRateState>& rates) {
    double sum = 0.0;
    for (const AngularRateState& rate : rates) sum += rate.covariance_rad2_s2.trace();
    return sum;
  };
  const auto of = [&](const std::string& wrong) {
    const Estimate estimate = run_wrong(draw, "rate/tumble", wrong);
    const std::vector<AngularRateState> before = testing::rates_without_suspect_terms(estimate);
    EXPECT_EQ(before.size(), estimate.rates.size());
    double squares = 0.0, least = 1.0;
    for (const AngularRateState& rate : estimate.rates) squares += 3.0 * rate.w_WI_I_rad_s.squaredNorm();
    for (const AngularRateState& rate : before) least = std::min(least, rate.covariance_rad2_s2.diagonal().minCoeff());
    EXPECT_GT(least, 0.0);
    return std::pair((trace(estimate.rates) - trace(before)) / squares, estimate.faults.invalidates_estimate());
  };
  EXPECT_EQ(of("none"), std::pair(0.0, false));
  const auto [share, doubted] = of("gyro_flipped");
  EXPECT_NEAR(share, 1.0, 1e-9);
  EXPECT_TRUE(doubted);
}

}  // namespace
}  // namespace tumble::scenarios
