// SPDX-License-Identifier: BSD-3-Clause
// The test compares the devices' data sheets with an hour of simulated rest, and checks the options of a scenario that
// the simulation uses.
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/errors.hpp"
#include "sim/imu/allan.hpp"
#include "sim/imu/bias.hpp"
#include "sim/imu/imu_simulation.hpp"
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using sim::AllanInterval;
using sim::AllanNoise;
using sim::AllanPoint;

constexpr double kHour_s = 3600.0;
constexpr double kGravity_m_s2 = 9.80665;

DataRoot data() {
  return {test::source_dir()};
}

std::vector<std::string> imus_of_the_sheets() {
  std::vector<std::string> imus;
  for (const std::string& name : device_names(data()))
    if (load_data_sheet(data(), name).sensor_kind == "imu") imus.push_back(name);
  return imus;
}

/// Returns the device with its data sheet's numbers, except the given ones; at rest the bandwidths have no effect and
/// are off, and so are windows shorter than a period, which let more of the noise pass, and the hold (sampling_test.cpp
/// has them).
sim::SensorSpec device(const std::string& name, const std::map<std::string, double>& given) {
  sim::SensorSpec sensor;
  sensor.name = "imu";
  sensor.device = name;
  sensor.values = sim::resolve(name, load_data_sheet(data(), name).values(), sim::imu_parameters());
  for (const char* off : {"gyro_bandwidth_hz", "accel_bandwidth_hz", "gyro_update_hz", "accel_update_hz",
                          "gyro_window_s", "accel_window_s", "digital_bandwidth_hz"})
    sensor.values.set(off, 0.0);
  for (const auto& [key, value] : given) sensor.values.set(key, value);
  return sensor;
}

struct Curves {
  std::vector<AllanPoint> gyro, accel;
};

std::vector<AllanPoint> curve_of(const std::vector<Vector3d>& samples, double period_s) {
  std::vector<std::vector<AllanPoint>> axes;
  for (int j = 0; j < 3; ++j) {
    std::vector<double> axis;
    for (const Vector3d& sample : samples) axis.push_back(sample[j]);
    axes.push_back(sim::allan_deviation(axis, period_s));
  }
  return sim::mean_deviation(axes);
}

Curves at_rest(const sim::SensorSpec& sensor, double duration_s, std::uint64_t seed) {
  sim::ImuRecord record;
  sim::ImuTruth truth;
  const double rate_hz = sensor.values.at("output_rate_hz");
  sim::simulate_imu_at_rest(sensor, duration_s, 2.0 * rate_hz, kGravity_m_s2, seed, record, truth);
  EXPECT_EQ(record.gyro_rad_s.size(), static_cast<std::size_t>(std::lround(duration_s * rate_hz)));
  return {curve_of(record.gyro_rad_s, 1.0 / rate_hz), curve_of(record.accel_m_s2, 1.0 / rate_hz)};
}

void expect_within(const AllanPoint& point, AllanNoise noise, double expected, const std::string& what) {
  const AllanInterval interval = confidence_interval(point, noise, 3.5);  // false alarm 0.05 % for each point
  EXPECT_LT(interval.low, expected) << what << " at " << point.tau_s << " s";
  EXPECT_GT(interval.high, expected) << what << " at " << point.tau_s << " s";
}

/// Returns the numbers of one triad that make an error at rest, all of them 0.
std::map<std::string, double> silent() {
  return {{"gyro_noise_rad_s_sqrt_hz", 0}, {"gyro_bias_in_run_rad_s", 0}, {"gyro_bias_walk_rad_s_sqrt_s", 0},
          {"gyro_quantum_rad_s", 0},       {"gyro_handover_rad_s", 0},    {"gyro_g_sensitivity_s_m", 0},
          {"accel_noise_m_s2_sqrt_hz", 0}, {"accel_bias_in_run_m_s2", 0}, {"accel_bias_walk_m_s2_sqrt_s", 0},
          {"accel_quantum_m_s2", 0},       {"accel_handover_m_s2", 0}};
}

class DataSheetNoise : public testing::TestWithParam<std::string> {
 protected:
  double number(const std::string& key) const { return device(GetParam(), {}).values.at(key); }
  /// Returns the device with every noise off except `keys`, which have the values of its data sheet.
  sim::SensorSpec only(const std::vector<std::string>& keys) const {
    std::map<std::string, double> given = silent();
    for (const std::string& key : keys) given.erase(key);
    return device(GetParam(), given);
  }
  void expect_white_noise_of_an_hour();
  void expect_bias_instability_of_an_hour();
  void expect_random_walk_of_an_hour();
  void expect_sum_of_noises();
};
class DataSheetNoiseSoak : public DataSheetNoise {};

void DataSheetNoise::expect_white_noise_of_an_hour() {
  const Curves curves = at_rest(only({"gyro_noise_rad_s_sqrt_hz", "accel_noise_m_s2_sqrt_hz"}), kHour_s, 11);
  for (const double tau_s : {0.02, 0.1, 1.0, 10.0, 60.0}) {
    const AllanPoint& gyro = nearest_point(curves.gyro, tau_s);
    const AllanPoint& accel = nearest_point(curves.accel, tau_s);
    expect_within(gyro, AllanNoise::white, sim::white_deviation(number("gyro_noise_rad_s_sqrt_hz"), gyro.tau_s),
                  "gyro");
    expect_within(accel, AllanNoise::white, sim::white_deviation(number("accel_noise_m_s2_sqrt_hz"), accel.tau_s),
                  "accel");
  }
  // an hour of data distinguishes a difference of 3 %
  const AllanPoint& sharp = nearest_point(curves.gyro, 0.1);
  EXPECT_GT(confidence_interval(sharp, AllanNoise::white).low,
            0.97 * sim::white_deviation(number("gyro_noise_rad_s_sqrt_hz"), sharp.tau_s));
}

void DataSheetNoise::expect_bias_instability_of_an_hour() {
  const Curves curves = at_rest(only({"gyro_bias_in_run_rad_s", "accel_bias_in_run_m_s2"}), kHour_s, 12);
  for (const double tau_s : {10.0, 25.0, 63.0, 160.0}) {
    // the minimum of four processes is within 5 % of the stated figure (BiasStage.InRunHasAFlatFloorAtItsFigure)
    const AllanPoint& gyro = nearest_point(curves.gyro, tau_s);
    const AllanPoint& accel = nearest_point(curves.accel, tau_s);
    expect_within(gyro, AllanNoise::flicker, 0.98 * number("gyro_bias_in_run_rad_s"), "gyro");
    expect_within(accel, AllanNoise::flicker, 0.98 * number("accel_bias_in_run_m_s2"), "accel");
  }
}

void DataSheetNoise::expect_random_walk_of_an_hour() {
  const Curves curves = at_rest(only({"gyro_bias_walk_rad_s_sqrt_s", "accel_bias_walk_m_s2_sqrt_s"}), kHour_s, 13);
  // the sheet states no random walk: constant except for the last bits
  if (number("gyro_bias_walk_rad_s_sqrt_s") == 0.0) {
    EXPECT_EQ(curves.gyro.front().deviation, 0.0);
    EXPECT_LT(curves.accel.front().deviation, 1e-14);
    return;
  }
  for (const double tau_s : {1.0, 10.0, 100.0, 300.0}) {
    const AllanPoint& gyro = nearest_point(curves.gyro, tau_s);
    const AllanPoint& accel = nearest_point(curves.accel, tau_s);
    expect_within(gyro, AllanNoise::walk, sim::walk_deviation(number("gyro_bias_walk_rad_s_sqrt_s"), gyro.tau_s),
                  "gyro");
    expect_within(accel, AllanNoise::walk, sim::walk_deviation(number("accel_bias_walk_m_s2_sqrt_s"), accel.tau_s),
                  "accel");
  }
}

void DataSheetNoise::expect_sum_of_noises() {
  // the test runs without quantisation, because for a device with little noise the step adds up to a tenth to the white
  // noise
  const sim::SensorSpec sensor = device(
      GetParam(),
      {{"gyro_handover_rad_s", 0}, {"accel_handover_m_s2", 0}, {"gyro_quantum_rad_s", 0}, {"accel_quantum_m_s2", 0}});
  const Curves curves = at_rest(sensor, kHour_s, 14);
  ASSERT_GT(curves.gyro.size(), 15u);
  for (const AllanPoint& point : curves.gyro) {
    if (point.tau_s < 0.05) continue;
    const sim::Bias::Params in_run{.in_run = number("gyro_bias_in_run_rad_s"),
                                   .in_run_s = number("gyro_bias_in_run_s")};
    const double expected = std::hypot(sim::white_deviation(number("gyro_noise_rad_s_sqrt_hz"), point.tau_s),
                                       sim::Bias::in_run_deviation(in_run, point.tau_s),
                                       sim::walk_deviation(number("gyro_bias_walk_rad_s_sqrt_s"), point.tau_s));
    expect_within(point, point.tau_s < 10.0 ? AllanNoise::white : AllanNoise::flicker, expected, "gyro");
  }
}

TEST_P(DataSheetNoise, WhiteNoiseOfAnHourAgrees) {
  expect_white_noise_of_an_hour();
}
TEST_P(DataSheetNoise, BiasInstabilityOfAnHourIsTheFloor) {
  expect_bias_instability_of_an_hour();
}
TEST_P(DataSheetNoise, RandomWalkOfAnHourAgrees) {
  expect_random_walk_of_an_hour();
}
TEST_P(DataSheetNoise, WholeDeviceIsTheSumOfItsNoises) {
  expect_sum_of_noises();
}
INSTANTIATE_TEST_SUITE_P(Devices, DataSheetNoise, testing::Values("mti30", "phidget1044"));

TEST_P(DataSheetNoiseSoak, AgreesWithTheSheetOfEveryDevice) {
  expect_white_noise_of_an_hour();
  expect_bias_instability_of_an_hour();
  expect_random_walk_of_an_hour();
  expect_sum_of_noises();
}
INSTANTIATE_TEST_SUITE_P(Devices, DataSheetNoiseSoak, testing::ValuesIn(imus_of_the_sheets()));

TEST(DataSheetNoise, AWrongFigureIsFound) {
  // the negative controls are 10 % more white noise, twice the floor and twice the random walk
  sim::SensorSpec sensor = device("mti30", silent());
  const double white = 5.23598776e-4, floor = 8.7266463e-5, walk = 2.0e-6;
  sensor.values.set("gyro_noise_rad_s_sqrt_hz", 1.1 * white);
  const AllanPoint noisy = nearest_point(at_rest(sensor, 600.0, 1).gyro, 0.1);
  EXPECT_GT(confidence_interval(noisy, AllanNoise::white, 3.5).low, sim::white_deviation(white, noisy.tau_s));
  sensor = device("mti30", silent());
  sensor.values.set("gyro_bias_in_run_rad_s", 2.0 * floor);
  const AllanPoint wandering = nearest_point(at_rest(sensor, kHour_s, 1).gyro, 63.0);
  EXPECT_GT(confidence_interval(wandering, AllanNoise::flicker, 3.5).low, floor);
  sensor = device("mti30", silent());
  sensor.values.set("gyro_bias_walk_rad_s_sqrt_s", 2.0 * walk);
  const AllanPoint walking = nearest_point(at_rest(sensor, kHour_s, 1).gyro, 10.0);
  EXPECT_GT(confidence_interval(walking, AllanNoise::walk, 3.5).low, sim::walk_deviation(walk, walking.tau_s));
}

TEST(DataSheetNoise, PhidgetAtRestIsReadByItsPrecisePart) {
  const sim::SensorSpec sensor = device("phidget1044", {});
  const AllanPoint gyro = nearest_point(at_rest(sensor, 300.0, 5).gyro, 0.02);
  const AllanPoint accel = nearest_point(at_rest(sensor, 300.0, 5).accel, 0.02);
  // the quantum of 0.02 deg/s is small against 0.13 deg/s of noise: it adds noise of 1 % of the variance
  expect_within(gyro, AllanNoise::white, 1.004 * sim::white_deviation(1.048661e-4, gyro.tau_s), "gyro");
  expect_within(accel, AllanNoise::white, 1.003 * sim::white_deviation(1.736638e-4, accel.tau_s), "accel");
}

TEST(DataSheets, EveryImuStatesEveryNumberOfItsKind) {
  const std::vector<std::string> imus = imus_of_the_sheets();
  ASSERT_GE(imus.size(), 4u);
  for (const std::string& name : imus) {
    const DataSheet sheet = load_data_sheet(data(), name);
    std::vector<std::string> stated, known;
    for (const DataSheet::Entry& entry : sheet.entries) {
      stated.push_back(entry.name);
      EXPECT_FALSE(entry.source.empty()) << name << " " << entry.name;
    }
    for (const sim::Parameter& parameter : sim::imu_parameters()) known.emplace_back(parameter.name);
    EXPECT_THAT(stated, testing::UnorderedElementsAreArray(known)) << name;
  }
}

/// Returns the first IMU of a draw of the hill with other options.
sim::SensorSpec drawn_imu(const std::string& options) {
  const std::string text = R"(
name: options
doc: one IMU
duration_s: 1
world: {type: hill}
robot: {type: rig}
motion: {type: push}
sensors:
  - {name: imu, kind: imu, device: mti30, site: mti30)" +
                           options + "}\n";
  const Scenario scenario = parse_scenario(text, "options.yaml", Registry::of_simulation());
  return draw(data(), scenario, 3)->sensors.at(0);
}

TEST(ScenarioOptions, EveryKindOfRailIsReached) {
  EXPECT_EQ(drawn_imu("").values.at("gyro_rail_rad_s"), 10.5);
  EXPECT_EQ(drawn_imu(", gyro_rail_rad_s: 7.853981634").values.at("gyro_rail_rad_s"), 7.853981634);
  EXPECT_EQ(drawn_imu(", gyro_plateau_axis_spread_rad_s: 0.2").values.at("gyro_plateau_axis_spread_rad_s"), 0.2);
  EXPECT_EQ(drawn_imu(", gyro_plateau_event_spread_rad_s: 0.1").values.at("gyro_plateau_event_spread_rad_s"), 0.1);
  EXPECT_EQ(drawn_imu(", gyro_wrap: 1").values.at("gyro_wrap"), 1.0);
  EXPECT_EQ(drawn_imu(", gyro_slow_recovery_s: 0.1, gyro_slow_recovery_share: 0.1").values.at("gyro_slow_recovery_s"),
            0.1);
  EXPECT_EQ(drawn_imu(", clip_after_low_pass: 1").values.at("clip_after_low_pass"), 1.0);
  EXPECT_EQ(drawn_imu(", accel_rail_m_s2: 49.03325").values.at("accel_rail_m_s2"), 49.03325);
  EXPECT_EQ(drawn_imu(", output_rate_hz: 400").values.at("output_rate_hz"), 400.0);
  EXPECT_EQ(drawn_imu(", magnetometer: 1, magnetic_sources: 5").values.at("magnetic_sources"), 5.0);
  const double drawn = drawn_imu(", gyro_rail_rad_s: {uniform: [9, 12]}").values.at("gyro_rail_rad_s");
  EXPECT_GT(drawn, 9.0);
  EXPECT_LT(drawn, 12.0);
}

TEST(ScenarioOptions, UnknownAndContradictoryKeysAreRefused) {
  const auto complaint = [](const std::string& options) -> std::string {
    try {
      drawn_imu(options);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint(", gyro_warp: 1"), HasSubstr("did you mean 'gyro_wrap'"));
  EXPECT_THAT(complaint(", gyro_rail_rad_s: 0, gyro_wrap: 1"), HasSubstr("gyro_wrap needs a saturation level"));
  EXPECT_THAT(complaint(", accel_plateau_axis_spread_m_s2: 90"), HasSubstr("below a third of accel_rail_m_s2"));
}

}  // namespace
}  // namespace tumble::scenarios
