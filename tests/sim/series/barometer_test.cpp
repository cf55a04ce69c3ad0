// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fixed_series.hpp"
#include "sim/series/series_sensors.hpp"

namespace tumble::sim {
namespace {

constexpr double kGravity_m_s2 = 9.80665;

TEST(Barometer, FollowsTheStandardAtmosphere) {
  EXPECT_EQ(air_pressure_pa(101325.0, 288.15, kGravity_m_s2, 0.0), 101325.0);
  // scale height R T / (g M) = 8434.5 m at 15 degrees Celsius
  EXPECT_NEAR(air_pressure_pa(101325.0, 288.15, kGravity_m_s2, 8434.5), 101325.0 / std::exp(1.0), 1.0);
}

TEST(Barometer, WithoutErrorsSaysTheMeanOverItsWindowAtItsPlace) {
  Recording recording;
  recording.truth = rising(10.0);
  const SensorSpec spec = sensor("barometer", {});
  const Eigen::Isometry3d T_BX(Eigen::Translation3d(0.0, 0.0, 0.1));
  const engine::World world{};
  barometer_sensor().simulate({world, spec, T_BX, T_BX, kGravity_m_s2, 1, 1}, recording);
  ASSERT_EQ(recording.sensors.series.size(), 1u);
  const SeriesRecord& series = recording.sensors.series[0];
  EXPECT_EQ(series.kind, "barometer");
  ASSERT_EQ(series.quantities.size(), 1u);
  EXPECT_EQ(series.quantities[0].name, "pressure_pa");
  ASSERT_EQ(series.quantities[0].values.size(), 500u);
  for (std::size_t k = 0; k < 500; ++k) {
    // upside down: 0.1 m below the centre of mass; the steps of a window extend from half a step before it to its end
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
