// SPDX-License-Identifier: BSD-3-Clause
// The test checks that one wild reading in a recording costs the project's methods one reading.
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

/// A Wild is a wild reading of the first IMU at a time, on one axis, of the gyro or of the accelerometer.
struct Wild {
  double time_s;
  bool of_gyro;
  int axis;
  double value;
};

std::size_t sample_of(const sim::ImuRecord& imu, const Wild& wild) {
  const auto after = std::lower_bound(imu.time_ns.begin(), imu.time_ns.end(), std::int64_t(1e9 * wild.time_s));
  return static_cast<std::size_t>(after - imu.time_ns.begin());
}

sim::Recording with_wild(sim::Recording recording, const Wild& wild) {
  sim::ImuRecord& imu = recording.sensors.imus.front();
  (wild.of_gyro ? imu.gyro_rad_s : imu.accel_m_s2)[sample_of(imu, wild)][wild.axis] = wild.value;
  return recording;
}

sim::Recording with_lost(sim::Recording recording, const Wild& wild) {
  sim::ImuRecord& imu = recording.sensors.imus.front();
  const auto k = static_cast<std::ptrdiff_t>(sample_of(imu, wild));
  const auto erase = [k](auto& rows) {
    if (!rows.empty()) rows.erase(rows.begin() + k);
  };
  erase(imu.time_ns), erase(imu.gyro_rad_s), erase(imu.accel_m_s2), erase(imu.clip_flags), erase(imu.magnetic_field_t);
  return recording;
}

Estimate run(const std::string& method, const sim::Recording& recording) {
  Estimate estimate = find_methods(method).front()->run(recording.sensors, {}, {});
  EXPECT_TRUE(estimate.status.ok()) << method << ' ' << estimate.status.message();
  return estimate;
}

/// Returns the largest distance between states of the same time.
template <class State, class Distance>
double farthest(const std::vector<State>& found, const std::vector<State>& expected, const Distance& distance) {
  if (found.size() + 1 < expected.size() || expected.empty()) return std::numeric_limits<double>::infinity();
  double out = 0.0;
  auto at = expected.begin();
  for (const State& state : found) {
    while (at != expected.end() && at->time_ns < state.time_ns) ++at;
    if (at == expected.end()) break;
    if (at->time_ns == state.time_ns) out = std::max(out, distance(state, *at));
  }
  return out;
}

/// Returns the largest distance between the rates [rad/s] or the attitudes [rad] of two estimates.
double apart(Kind kind, const Estimate& found, const Estimate& expected) {
  if (kind == Kind::rate) {
    return farthest(found.rates, expected.rates, [](const AngularRateState& a, const AngularRateState& b) {
      return (a.w_WI_I_rad_s - b.w_WI_I_rad_s).norm();
    });
  }
  return farthest(found.attitudes, expected.attitudes,
                  [](const auto& a, const auto& b) { return a.orientation_W.angularDistance(b.orientation_W); });
}

/// The first reading is in motion and beyond twice the gyro's range; the second one is of the accelerometer at rest.
constexpr Wild kWild[] = {{3.3, true, 2, 200.0}, {1.1, false, 2, 150.0}};
constexpr Wild kGyroAtRest[] = {{1.0, true, 0, 9.0}};

/// The estimate must equal the estimate from a recording without this sample.
void expect_one_sample_lost(const std::string& method, const sim::Recording& recording, std::span<const Wild> all) {
  const Kind kind = find_methods(method).front()->info.kind;
  for (const Wild& wild : all) {
    const Estimate found = run(method, with_wild(recording, wild)), lost = run(method, with_lost(recording, wild));
    EXPECT_EQ(apart(kind, found, lost), 0.0) << method << ' ' << wild.time_s << ' ' << wild.value;
    EXPECT_EQ(found.health.at("rejected_readings"), 1.0) << method << ' ' << wild.time_s << ' ' << wild.value;
  }
}

void expect_one_lost_sample_of_attitudes(std::span<const Wild> all) {
  const sim::Recording recording = testing::synthetic_rig();
  for (const char* method : {"attitude/tumble", "attitude/tumble_batch", "attitude/tumble_lag"})
    expect_one_sample_lost(method, recording, all);
}

TEST(Outliers, OneWildReadingOfARateIsOneLostSample) {
  const sim::Recording recording = testing::synthetic_rig();
  for (const char* method : {"rate/tumble", "rate/tumble_lag"}) {
    expect_one_sample_lost(method, recording, kWild);
    expect_one_sample_lost(method, recording, kGyroAtRest);
  }
}

TEST(Outliers, OneWildReadingOfAnAttitudeIsOneLostSample) {
  expect_one_lost_sample_of_attitudes(kWild);
}

// the methods reject readings at rest as they reject those above
TEST(OutliersSoak, OneWildReadingOfAGyroAtRestChangesNoAttitude) {
  expect_one_lost_sample_of_attitudes(kGyroAtRest);
}

}  // namespace
}  // namespace tumble::scenarios
