// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/triage.hpp"
#include "scenarios/methods/registry.hpp"

#include "scenarios/scoring/truth_track.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

/// Returns a tumble with all sensors, made once for all tests.
const SimulatedDraw& tumble() {
  static const SimulatedDraw kDraw = [] {
    Scenario scenario = load_scenario(test::tree_data(), "hill");
    scenario.duration_s.shape = Distribution::Shape::constant;
    scenario.duration_s.numbers = {5.0};
    scenario.sensors.push_back({"barometer", "barometer", "bmp388", "rs16", {}, {}, 0});
    return simulate_draw(test::tree_data(), scenario, 1, 1);
  }();
  return kDraw;
}

const TrueInput& input_named(const std::string& name) {
  const auto all = true_inputs();
  return *std::find_if(all.begin(), all.end(), [&](const TrueInput& input) { return input.name == name; });
}

TEST(TrueInputs, EachReplacesItsOwnAndDoingItTwiceChangesNothing) {
  const sim::Recording& recording = tumble().recording;
  for (const TrueInput& input : true_inputs()) {
    if (input.name == "stamps_exact" || input.name == "accel_unclipped" || input.name == "all") continue;
    sim::Sensors sensors = recording.sensors;
    EXPECT_TRUE(input.replace(sensors, recording.truth)) << input.name;
    EXPECT_FALSE(input.doc.empty()) << input.name;
  }
  sim::Sensors sensors = recording.sensors;
  EXPECT_TRUE(input_named("gyro_exact").replace(sensors, recording.truth));
  EXPECT_EQ(sensors.imus[0].gyro_rad_s, recording.truth.imus[0].rate_rad_s);
  EXPECT_EQ(sensors.imus[0].accel_m_s2, recording.sensors.imus[0].accel_m_s2);
  EXPECT_GT(sensors.imus[0].stated_gyro_range_rad_s, 10.0);
  EXPECT_FALSE(input_named("gyro_exact").replace(sensors, recording.truth));
  EXPECT_TRUE(input_named("mounting_exact").replace(sensors, recording.truth));
  EXPECT_FALSE(input_named("mounting_exact").replace(sensors, recording.truth));
  EXPECT_EQ(sensors.series.at(0).T_BX.matrix(), recording.truth.series.at(0).T_BX.matrix());
  EXPECT_TRUE(input_named("series_exact").replace(sensors, recording.truth));
  EXPECT_EQ(sensors.series[0].quantities.at(0).values, recording.truth.series[0].quantities.at(0).values);
}

TEST(TrueInputs, ExactStampsTakeAnOffsetAway) {
  sim::Sensors sensors = tumble().recording.sensors;
  const sim::ImuRecord& imu = sensors.imus[0];
  for (std::int64_t& time : sensors.imus[0].time_ns) time += 3'000'000;
  EXPECT_TRUE(input_named("stamps_exact").replace(sensors, tumble().recording.truth));
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    ASSERT_EQ(imu.time_ns[k], static_cast<std::int64_t>(k + 1) * imu.period_ns);
  }
  EXPECT_FALSE(input_named("stamps_exact").replace(sensors, tumble().recording.truth));
}

/// Returns the largest distance of the points of all sweeps, moved to the world by the true pose at their own times.
double largest_miss_m(const sim::Sensors& sensors, const sim::Truth& truth, std::size_t stride) {
  const TruthTrack track(truth, Frame::lidar);
  const sim::LidarRecord& lidar = sensors.lidars[0];
  double largest = 0.0;
  for (std::size_t sweep = 0; sweep < lidar.sweep_start_ns.size(); ++sweep) {
    for (std::uint64_t i = lidar.sweep_first[sweep]; i < lidar.sweep_first[sweep + 1]; i += stride) {
      const std::int64_t time_ns = lidar.sweep_start_ns[sweep] + lidar.offset_ns[i];
      if (!track.covers(time_ns)) continue;
      const PoseState pose = track.pose(time_ns);
      const Vector3d p_W_m = pose.orientation_W * lidar.position_L_m[i].cast<double>() + pose.position_W_m;
      largest = std::max(largest, (p_W_m - truth.lidars[0].hit_W_m[i].cast<double>()).norm());
    }
  }
  return largest;
}

TEST(TrueInputs, ExactRangesLieWhereTheBeamsHit) {
  const sim::Recording& recording = tumble().recording;
  EXPECT_GT(largest_miss_m(recording.sensors, recording.truth, 17), 0.03) << "the device errs by 2 cm, one sigma";
  sim::Sensors sensors = recording.sensors;
  ASSERT_TRUE(input_named("lidar_ranges_exact").replace(sensors, recording.truth));
  EXPECT_LT(largest_miss_m(sensors, recording.truth, 17), 1e-4);  // float rounding at 40 m
}

TEST(TrueInputs, UnbentSweepsLieRightAtOneInstant) {
  const sim::Recording& recording = tumble().recording;
  sim::Sensors sensors = recording.sensors;
  ASSERT_TRUE(input_named("all").replace(sensors, recording.truth));
  EXPECT_LT(largest_miss_m(sensors, recording.truth, 17), 1e-4);
  const sim::LidarRecord& lidar = sensors.lidars[0];
  for (std::size_t sweep = 0; sweep < lidar.sweep_start_ns.size(); ++sweep) {
    const std::uint64_t first = lidar.sweep_first[sweep], end = lidar.sweep_first[sweep + 1];
    if (end - first < 2) continue;
    for (std::uint64_t i = first + 1; i < end; i += 101) {
      ASSERT_LE(lidar.offset_ns[i] - lidar.offset_ns[first], 1000u);
    }
    ASSERT_LT(lidar.offset_ns[first], lidar.offset_ns[end - 1]) << "one stamp for all is what mappers refuse";
  }
}

/// The rate of `raw` fails where the gyro is saturated: the unsaturated gyro cures it, and the accelerometer does not.
TEST(Triage, TheClippedGyroIsTheCauseOfRawsError) {
  Scenario scenario = load_scenario(test::tree_data(), "hill");
  scenario.duration_s.shape = Distribution::Shape::constant;
  scenario.duration_s.numbers = {5.0};
  std::erase_if(scenario.sensors, [](const Scenario::Sensor& sensor) { return sensor.name == "lidar"; });
  TriageOptions options;
  options.failure = {"rate_error_clipped_median_rad_s", 0.1};
  const std::vector<TriageRow> rows =
      triage(test::tree_data(), scenario, 1, *find_methods("rate/raw").front(), options);
  ASSERT_GT(rows.size(), 4u);
  EXPECT_EQ(rows[0].input, "none");
  EXPECT_TRUE(rows[0].fails) << "seed 1 clips";
  std::vector<std::string> cures;
  for (const TriageRow& row : rows) {
    if (!row.fails) cures.push_back(row.input);
  }
  EXPECT_THAT(cures, ElementsAre("gyro_unclipped", "gyro_exact", "all"));
}

TEST(Triage, AMethodOfAnotherRobotIsRefused) {
  EXPECT_THROW(triage(test::tree_data(), load_scenario(test::tree_data(), "hill"), 1,
                      *find_methods("position/rolling").front(), {}),
               BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
