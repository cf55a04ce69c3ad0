// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sphere_imus.hpp"

#include "scenarios/estimates/findings.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::int64_t kPeriod_ns = 4'000'000;
constexpr int kSamples = 2500;

Vector3d rate_at(double time_s) {
  return {2.0 * std::sin(3.0 * time_s), 1.5 * std::cos(4.1 * time_s), std::sin(2.3 * time_s)};
}

/// Returns a unit at the centre of a body that turns about it. The unit's stamps are `stamped_late_s` after the times
/// to which its readings belong; the stamps begin at `first_ns`.
sim::ImuRecord unit(const char* name, std::int64_t first_ns, double stamped_late_s) {
  sim::ImuRecord record;
  record.name = name;
  record.device = "phidget1044";
  record.period_ns = kPeriod_ns;
  for (int k = 0; k < kSamples; ++k) {
    record.time_ns.push_back(first_ns + k * kPeriod_ns);
    const double time_s = 1e-9 * static_cast<double>(record.time_ns.back()) - stamped_late_s;
    record.gyro_rad_s.push_back(rate_at(time_s));
    record.accel_m_s2.push_back({std::sin(time_s), 0.0, 9.80665});
    record.clip_flags.push_back(0);
  }
  return record;
}

sim::Sensors three(const sim::ImuRecord& second, const sim::ImuRecord& third) {
  sim::Sensors sensors;
  sensors.robot = "sphere";
  sensors.sphere_radius_m = 0.145;
  sensors.imus = {unit("imu", 0, 0.0), second, third};
  return sensors;
}

MergedImus merged_of(const sim::Sensors& sensors) {
  MergedImus merged;
  const Status status = merge_imus(sensors, merged);
  EXPECT_TRUE(status.ok()) << status.message();
  return merged;
}

/// Returns the first fault of the IMUs as "KIND SENSOR AXIS", with the name of the IMU in the recording.
std::string fault_of(const MergedImus& merged) {
  Estimate estimate;
  add_findings(merged.merged.faults, merged.names, estimate);
  const HealthFinding& fault = estimate.faults.findings.at(0);
  return std::string(to_string(fault.kind)) + " " + fault.sensor + " " + fault.axis;
}

double since_s(const MergedImus& merged) {
  return seconds(merged.merged.faults.findings.at(0).since_ns.value_or(0));
}

double worst_rate_error(const MergedImus& merged) {
  double worst = 0.0;
  for (std::size_t k = 10; k + 10 < merged.merged.samples.size(); ++k) {
    const double time_s = 1e-9 * static_cast<double>(merged.merged.samples[k].time_ns);
    worst = std::max(worst, (merged.merged.samples[k].angular_velocity_rad_s - rate_at(time_s)).norm());
  }
  return worst;
}

TEST(SphereImus, UnitsWithStampsOfTheirOwnAreReadAtThePrimaryOnes) {
  const sim::Sensors sensors = three(unit("imu_2", 1'300'000, 0.0), unit("imu_3", -2'700'000, 0.0));
  const MergedImus merged = merged_of(sensors);
  EXPECT_EQ(merged.merged.imus.size(), 3U);
  ASSERT_EQ(merged.merged.samples.size(), static_cast<std::size_t>(kSamples));
  // between two samples, linear interpolation has an error of w'' T^2 / 8 = 30 rad/s^3 * 2e-6 s^2; the mean of three
  // units has a third of this error
  EXPECT_LT(worst_rate_error(merged), 1e-4);
  // without alignment, the error of the readings would be the distance of their stamps times the acceleration of 9
  // rad/s^2
  EXPECT_GT((rate_at(1.0013) - rate_at(1.0)).norm() / 3.0, 1e-3);
}

TEST(SphereImus, ATimeOffsetOfOneUnitIsEstimatedAndReported) {
  constexpr double kLate_s = 2e-3;
  const sim::Sensors sensors = three(unit("imu_2", 0, 0.0), unit("imu_3", 0, kLate_s));
  const MergedImus merged = merged_of(sensors);
  ASSERT_EQ(merged.merged.imus.size(), 3U);
  EXPECT_EQ(merged.merged.imus[2].imu_index, 2U);
  // the offset is relative to the mean of the three units, and the mean is late by a third of the delay
  EXPECT_NEAR(merged.merged.imus[2].time_offset_s, -2.0 / 3.0 * kLate_s, 1e-4);
  EXPECT_NEAR(merged.merged.imus[0].time_offset_s, 1.0 / 3.0 * kLate_s, 1e-4);
  EXPECT_GT(merged.merged.imus[2].time_offset_sigma_s, 0.0);
  EXPECT_LT(merged.merged.imus[2].time_offset_sigma_s, 1e-4);
}

TEST(SphereImus, AUnitThatEndsEarlyIsLeftOutFromThereOnAndNamed) {
  sim::ImuRecord ends = unit("imu_2", 1'000'000, 0.0);
  for (auto* rows : {&ends.gyro_rad_s, &ends.accel_m_s2}) rows->resize(kSamples / 2);
  ends.time_ns.resize(kSamples / 2);
  ends.clip_flags.resize(kSamples / 2);
  sim::ImuRecord nan = unit("imu_3", 0, 0.0);
  nan.gyro_rad_s[7].x() = std::nan("");  // a single missing reading is interpolated
  const MergedImus merged = merged_of(three(ends, nan));
  EXPECT_EQ(merged.merged.imus.size(), 3U);
  ASSERT_EQ(merged.merged.faults.findings.size(), 1U);
  EXPECT_EQ(fault_of(merged), "imu_silent imu_2 ");
  EXPECT_NEAR(since_s(merged), 5.0, 0.06);
  EXPECT_LT(worst_rate_error(merged), 1e-3);
}

TEST(SphereImus, ThePrimaryUnitMayDieToo) {
  sim::Sensors sensors = three(unit("imu_2", 0, 0.0), unit("imu_3", 0, 0.0));
  for (std::size_t k = kSamples / 3; k < kSamples; ++k) sensors.imus[0].gyro_rad_s[k].x() = std::nan("");
  const MergedImus merged = merged_of(sensors);
  ASSERT_EQ(merged.merged.samples.size(), static_cast<std::size_t>(kSamples));
  ASSERT_EQ(merged.merged.faults.findings.size(), 1U);
  EXPECT_EQ(fault_of(merged), "imu_silent imu ");
  EXPECT_LT(worst_rate_error(merged), 1e-6);
}

// a loose cable removes whole rows, and leaves all other rows correct
TEST(SphereImus, ThePrimaryUnitMayBeSilent) {
  constexpr std::size_t kFrom = kSamples / 3, kTo = kFrom + 500;
  for (const bool returns : {true, false}) {
    sim::Sensors sensors = three(unit("imu_2", 0, 0.0), unit("imu_3", 1'000'000, 0.0));
    const auto lose = [&](auto& rows) { rows.erase(rows.begin() + kFrom, returns ? rows.begin() + kTo : rows.end()); };
    sim::ImuRecord& primary = sensors.imus[0];
    lose(primary.time_ns), lose(primary.gyro_rad_s), lose(primary.accel_m_s2), lose(primary.clip_flags);
    const MergedImus merged = merged_of(sensors);
    ASSERT_EQ(merged.merged.samples.size(), static_cast<std::size_t>(kSamples));
    ASSERT_EQ(merged.merged.faults.findings.size(), 1U);
    EXPECT_EQ(fault_of(merged), "imu_silent imu ");
    EXPECT_LT(worst_rate_error(merged), 1e-4);
  }
}

TEST(SphereImus, AFrozenUnitIsLeftOutFromTheBeginningOfItAndNamed) {
  for (std::size_t frozen = 0; frozen < 3; ++frozen) {
    sim::Sensors sensors = three(unit("imu_2", 0, 0.0), unit("imu_3", 0, 0.0));
    MergedImus merged = merged_of(sensors);
    EXPECT_TRUE(merged.merged.faults.ok());
    sim::ImuRecord& record = sensors.imus[frozen];
    for (std::size_t k = kSamples / 3; k < kSamples; ++k) {
      record.gyro_rad_s[k] = record.gyro_rad_s[kSamples / 3];
      record.accel_m_s2[k] = record.accel_m_s2[kSamples / 3];
    }
    merged = merged_of(sensors);
    ASSERT_EQ(merged.merged.faults.findings.size(), 1U) << frozen;
    EXPECT_EQ(fault_of(merged), "imu_frozen " + record.name + " ");
    EXPECT_NEAR(since_s(merged), 1e-9 * static_cast<double>(record.time_ns[kSamples / 3]), 1e-9);
    EXPECT_LT(worst_rate_error(merged), 1e-6) << frozen;  // the calibration ignored the frozen IMU
  }
}

TEST(SphereImus, AUnitOfOtherUnitsIsLeftOutAndNamed) {
  sim::Sensors sensors = three(unit("imu_2", 0, 0.0), unit("imu_3", 0, 0.0));
  for (Vector3d& force : sensors.imus[1].accel_m_s2) force /= 9.80665;
  const MergedImus merged = merged_of(sensors);
  ASSERT_EQ(merged.merged.faults.findings.size(), 1U);
  EXPECT_EQ(fault_of(merged), "imu_disagrees imu_2 ");
  EXPECT_EQ(merged.merged.imus.size(), 2U);
  EXPECT_NEAR(merged.merged.samples[100].specific_force_m_s2.z(), 9.80665, 1e-9);
}

/// Returns a record of a gyro with a range of 5 rad/s. From a third of the run on, axis z repeats its reading.
sim::ImuRecord frozen_z(sim::ImuRecord record) {
  record.stated_gyro_range_rad_s = 5.0;
  for (std::size_t k = kSamples / 3; k < kSamples; ++k) record.gyro_rad_s[k].z() = record.gyro_rad_s[kSamples / 3].z();
  return record;
}

TEST(SphereImus, AUnitOfWhichOneAxisFreezesIsLeftOutAndTheAxisNamed) {
  const sim::Sensors sensors = three(frozen_z(unit("imu_2", 0, 0.0)), unit("imu_3", 0, 0.0));
  const MergedImus merged = merged_of(sensors);
  ASSERT_EQ(merged.merged.faults.findings.size(), 1U);
  EXPECT_EQ(fault_of(merged), "imu_frozen imu_2 gyro_z");
  EXPECT_NEAR(since_s(merged), 1e-9 * static_cast<double>(sensors.imus[0].time_ns[kSamples / 3]), 1e-9);
  EXPECT_LT(worst_rate_error(merged), 1e-6);
}

TEST(SphereImus, WhereOneAxisFreezesInAllUnitsTheRunIsRefused) {
  sim::Sensors sensors = three(frozen_z(unit("imu_2", 0, 0.0)), frozen_z(unit("imu_3", 0, 0.0)));
  sensors.imus[0] = frozen_z(sensors.imus[0]);
  MergedImus merged;
  const Status status = merge_imus(sensors, merged);
  EXPECT_EQ(status.error_code, ErrorCode::out_of_range);
  EXPECT_NE(std::string(status.field).find("gyro z"), std::string::npos) << status.message();
  EXPECT_EQ(merged.merged.faults.findings.size(), 3U);
}

TEST(SphereImus, AnAxisAtItsRailOrThatIsReadMoreSlowlyIsNotFrozen) {
  sim::ImuRecord clips = unit("imu_2", 0, 0.0), slow = unit("imu_3", 0, 0.0);
  clips.stated_gyro_range_rad_s = 0.5;  // for up to a second
  for (Vector3d& rate : clips.gyro_rad_s) rate.z() = std::clamp(rate.z(), -0.5, 0.5);
  for (std::size_t k = 0; k < kSamples; ++k) slow.gyro_rad_s[k].z() = slow.gyro_rad_s[k - k % 20].z();
  const MergedImus merged = merged_of(three(clips, slow));
  for (const HealthFinding& finding : merged.merged.faults.findings) EXPECT_STREQ(finding.axis, "") << finding.sensor;
}

TEST(SphereImus, ReadingsOfOneUnitBeyondItsRangeAreLeftOutAndCounted) {
  sim::ImuRecord spikes = unit("imu_2", 0, 0.0);
  spikes.stated_gyro_range_rad_s = 5.0;
  for (std::size_t k = 100; k < kSamples; k += 301) spikes.gyro_rad_s[k].x() = 3e5;
  const MergedImus merged = merged_of(three(spikes, unit("imu_3", 0, 0.0)));
  EXPECT_EQ(merged.beyond_range, 8);
  EXPECT_LT(worst_rate_error(merged), 1e-3);
}

}  // namespace
}  // namespace tumble::scenarios
