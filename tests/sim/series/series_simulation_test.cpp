// SPDX-License-Identifier: BSD-3-Clause
#include "sim/series/series_simulation.hpp"

#include "fixed_series.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "sim/engine/model.hpp"
#include "sim/series/series_sensors.hpp"
#include "sim/simulate.hpp"
#include "tests/scenarios/testing.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns readings of a quantity that is always 7, and of one that is twice that.
Recording sevens(const std::map<std::string, double>& given, const ReadingErrors& errors, double duration_s = 10.0,
                 std::uint64_t seed = 1) {
  Recording recording;
  recording.truth = rising(duration_s);
  const SensorSpec spec = sensor("barometer", given);
  const Isometry3d T_BX(Eigen::Translation3d(1.0, 2.0, 3.0)), given_T_BX(Eigen::Translation3d(1.0, 2.0, 3.5));
  const engine::World world{};
  const auto seven = [](std::size_t) { return 7.0; };
  const auto fourteen = [](std::size_t) { return 14.0; };
  simulate_series({world, spec, T_BX, given_T_BX, 9.8, seed, 1},
                  {{"a_m", "m", errors, seven}, {"b_m", "m", errors, fourteen}}, {"air_temperature_k"}, recording);
  return recording;
}

double deviation(const std::vector<double>& values, double about) {
  double squares = 0.0;
  for (const double value : values) squares += (value - about) * (value - about);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(Series, WithoutErrorsIsTheTruth) {
  const Recording recording = sevens({}, {});
  const SeriesRecord& series = recording.sensors.series.at(0);
  ASSERT_EQ(series.time_ns.size(), 500u);
  EXPECT_EQ(series.period_ns, 20'000'000);
  EXPECT_EQ(series.time_ns.front(), 20'000'000);
  EXPECT_EQ(series.quantities[1].values, std::vector<double>(500, 14.0));
  EXPECT_EQ(series.quantities[0].values, recording.truth.series.at(0).quantities[0].values);
  ASSERT_EQ(series.constants.size(), 1u);
  EXPECT_EQ(series.constants[0].name, "air_temperature_k");
  EXPECT_EQ(series.constants[0].value, 288.15);
  EXPECT_EQ(series.T_BX.translation().z(), 3.5);
  EXPECT_EQ(recording.truth.series[0].T_BX.translation().z(), 3.0);
  EXPECT_EQ(scenarios::find_mismatch(recording.sensors, recording.truth), "");
}

TEST(Series, EachQuantityHasNoiseAndABiasOfItsOwn) {
  ReadingErrors noisy;
  noisy.noise = 3.0;
  const Recording recording = sevens({}, noisy, 100.0);
  const std::vector<Quantity>& read = recording.sensors.series.at(0).quantities;
  // 5000 samples determine the standard deviation to 1 %: the bound is 4 of them
  EXPECT_NEAR(deviation(read[0].values, 7.0), 3.0, 0.12);
  EXPECT_NE(read[0].values[0] - 7.0, read[1].values[0] - 14.0);
  EXPECT_EQ(read[0].noise, 3.0);
  ReadingErrors biased;
  biased.bias = 50.0;
  const std::vector<double> one = sevens({}, biased).sensors.series.at(0).quantities[0].values;
  EXPECT_NE(one[0], 7.0);
  EXPECT_EQ(one.front(), one.back());
  EXPECT_NE(sevens({}, biased, 1.0, 2).sensors.series.at(0).quantities[0].values[0], one[0]);
}

TEST(Series, StopsAtItsRangeAndHasAStep) {
  ReadingErrors short_of;
  short_of.high = 8.0;
  EXPECT_EQ(sevens({}, short_of).sensors.series.at(0).quantities[1].values.back(), 8.0);
  ReadingErrors coarse;
  coarse.quantum = 4.0;
  EXPECT_EQ(sevens({}, coarse).sensors.series.at(0).quantities[0].values.back(), 8.0);
  coarse.high = 7.5;  // 7 would be rounded to 8, which exceeds the limit
  EXPECT_EQ(sevens({}, coarse).sensors.series.at(0).quantities[0].values.back(), 7.5);
}

TEST(Series, WhatIsLostIsLostFromTheTruthToo) {
  ReadingErrors noisy;
  noisy.noise = 3.0;
  const Recording all = sevens({}, noisy), some = sevens({{"dropout_share", 0.3}}, noisy);
  const SeriesRecord& series = some.sensors.series.at(0);
  EXPECT_LT(series.time_ns.size(), 450u);
  EXPECT_GT(series.time_ns.size(), 250u);
  EXPECT_EQ(scenarios::find_mismatch(some.sensors, some.truth), "");
  // the readings that arrive are the same as without losses
  const std::size_t row = static_cast<std::size_t>(series.time_ns.back() / 20'000'000) - 1;
  EXPECT_EQ(series.quantities[0].values.back(), all.sensors.series.at(0).quantities[0].values.at(row));
}

TEST(Series, ARateThatDoesNotDivideIsRefused) {
  EXPECT_THROW(sevens({{"output_rate_hz", 30.0}}, {}), InvalidSituation);
  EXPECT_NO_THROW(sevens({{"output_rate_hz", 40.0}}, {}));
}

TEST(Series, AScenarioCarriesOneAndNoOtherSensorChanges) {
  const scenarios::DataRoot data = test::tree_data();
  scenarios::Scenario scenario = scenarios::load_scenario(data, "bare");
  scenario.duration_s.shape = scenarios::Distribution::Shape::constant;
  scenario.duration_s.numbers = {3.0};
  scenario.sensors.resize(1);  // the primary IMU
  const auto simulated = [&] {
    return simulate(BuiltSituation(scenarios::draw(data, scenario, 1001), data.models()), 1);
  };
  const Recording without = simulated();
  scenario.sensors.push_back({"barometer", "barometer", "bmp388", "rs16", {}, {}, 0});
  const Recording with = simulated();
  EXPECT_EQ(with.sensors.imus.at(0).gyro_rad_s, without.sensors.imus.at(0).gyro_rad_s);
  ASSERT_TRUE(without.sensors.series.empty());
  EXPECT_EQ(scenarios::find_mismatch(with.sensors, with.truth), "");
  const Quantity& pressure = with.sensors.series.at(0).quantities.at(0);
  const std::vector<double>& exact_pa = with.truth.series.at(0).quantities.at(0).values;
  ASSERT_EQ(pressure.values.size(), 150u);
  double mean_pa = 0.0;
  for (std::size_t k = 0; k < pressure.values.size(); ++k) mean_pa += (pressure.values[k] - exact_pa[k]) / 150.0;
  // the offset of 50 Pa is drawn once and lies within 4 standard deviations, and each reading varies about it by 2 Pa
  EXPECT_LT(std::abs(mean_pa), 200.0);
  for (std::size_t k = 0; k < pressure.values.size(); ++k)
    EXPECT_NEAR(pressure.values[k] - exact_pa[k], mean_pa, 10.0) << k;
  // the body rolls down some metres, each of 11.8 Pa
  EXPECT_GT(exact_pa.back() - exact_pa.front(), 5.0);
}

constexpr double kGravity_m_s2 = 9.80665;

TEST(Barometer, FollowsTheStandardAtmosphere) {
  EXPECT_EQ(air_pressure_pa(101325.0, 288.15, kGravity_m_s2, 0.0), 101325.0);
  // the scale height is R T / (g M) = 8434.5 m at 15 degrees Celsius
  EXPECT_NEAR(air_pressure_pa(101325.0, 288.15, kGravity_m_s2, 8434.5), 101325.0 / std::exp(1.0), 1.0);
}

TEST(Barometer, WithoutErrorsSaysTheMeanOverItsWindowAtItsPlace) {
  Recording recording;
  recording.truth = rising(10.0);
  const SensorSpec spec = sensor("barometer", {});
  const Isometry3d T_BX(Eigen::Translation3d(0.0, 0.0, 0.1));
  const engine::World world{};
  barometer_sensor().simulate({world, spec, T_BX, T_BX, kGravity_m_s2, 1, 1}, recording);
  ASSERT_EQ(recording.sensors.series.size(), 1u);
  const SeriesRecord& series = recording.sensors.series[0];
  EXPECT_EQ(series.kind, "barometer");
  ASSERT_EQ(series.quantities.size(), 1u);
  EXPECT_EQ(series.quantities[0].name, "pressure_pa");
  ASSERT_EQ(series.quantities[0].values.size(), 500u);
  for (std::size_t k = 0; k < 500; ++k) {
    // the body is upside down, 0.1 m below the centre of mass; the steps of a window are from half a step before to its
    // end
    const double height_m = 0.02 * static_cast<double>(k) + 0.01025 - 0.1;
    EXPECT_NEAR(series.quantities[0].values[k], air_pressure_pa(101325.0, 288.15, kGravity_m_s2, height_m), 1e-6) << k;
  }
}

TEST(Barometer, RefusesARangeThatIsNone) {
  const SensorSpec spec = sensor("barometer", {{"pressure_min_pa", 2e5}});
  EXPECT_THROW(barometer_sensor().check(spec.values, "sensors.it"), InvalidSituation);
  EXPECT_NO_THROW(barometer_sensor().check(sensor("barometer", {}).values, "sensors.it"));
}

}  // namespace
}  // namespace tumble::sim
