// SPDX-License-Identifier: BSD-3-Clause
// The test checks what an import reports about readings that cannot be what their names state.
#include "scenarios/methods/imu_check.hpp"

#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kGravity_m_s2 = 9.81;

/// Returns twenty seconds at 100 Hz of a body that turns about all three axes, with noise, so that the last digits
/// change.
sim::ImuRecord turning() {
  sim::ImuRecord imu;
  imu.name = "imu";
  imu.period_ns = 10'000'000;
  Quaterniond q_WI = Eigen::Quaterniond::Identity();
  for (int k = 0; k < 2000; ++k) {
    const double t = 0.01 * k;
    const Vector3d rate(0.9 * std::sin(0.8 * t), 0.7 * std::cos(0.6 * t), 0.5 * std::sin(0.3 * t + 1.0));
    q_WI = (q_WI * so3::exp(Vector3d(0.01 * rate))).normalized();
    imu.time_ns.push_back((k + 1) * imu.period_ns);
    imu.gyro_rad_s.emplace_back(rate + 1e-3 * Vector3d(std::sin(7.1 * k), std::cos(3.3 * k), std::sin(1.7 * k)));
    imu.accel_m_s2.emplace_back(q_WI.conjugate() * Vector3d(0.0, 0.0, kGravity_m_s2));
    imu.clip_flags.push_back(0);
  }
  return imu;
}

std::string note_of(const std::function<void(sim::ImuRecord&)>& spoil) {
  sim::ImuRecord imu = turning();
  spoil(imu);
  return imu_note(imu, kGravity_m_s2);
}

TEST(ImuNotes, OfASoundImuAreNone) {
  EXPECT_EQ(note_of([](sim::ImuRecord&) {}), "");
}

TEST(ImuNotes, WhatFrozeIsSaid) {
  EXPECT_THAT(note_of([](sim::ImuRecord& imu) {
                for (std::size_t k = 600; k < 2000; ++k)
                  imu.gyro_rad_s[k] = imu.gyro_rad_s[600], imu.accel_m_s2[k] = imu.accel_m_s2[600];
              }),
              HasSubstr("caution: the sensor repeats one reading"));
}

TEST(ImuNotes, AxesThatContradictTheRotationAreSaid) {
  // the accelerometer's x contains what belongs to the gyro's y, and so on
  EXPECT_THAT(note_of([](sim::ImuRecord& imu) {
                for (Vector3d& f : imu.accel_m_s2) f = Vector3d(f.y(), f.z(), f.x());
              }),
              HasSubstr("caution: the gyro contradicts the rotation"));
  EXPECT_THAT(note_of([](sim::ImuRecord& imu) {
                for (Vector3d& f : imu.accel_m_s2) f.z() = -f.z();
              }),
              HasSubstr("caution: the gyro contradicts the rotation"));
}

TEST(ImuNotes, ForcesThatAreNotGravitysAreSaid) {
  EXPECT_THAT(note_of([](sim::ImuRecord& imu) {
                for (std::size_t k = 0; k < imu.time_ns.size(); ++k)
                  imu.gyro_rad_s[k] *= 1e-3, imu.accel_m_s2[k] = 0.5 * imu.accel_m_s2[0];
              }),
              HasSubstr("caution: the specific force at rest differs from gravity"));
}

TEST(ImuNotes, EachImuIsNamed) {
  Imported imported;
  imported.sensors.gravity_m_s2 = kGravity_m_s2;
  imported.sensors.imus = {turning(), turning()};
  imported.sensors.imus[1].name = "second";
  for (Vector3d& w : imported.sensors.imus[1].gyro_rad_s) w *= -1.0;
  EXPECT_THAT(imu_notes(imported), ElementsAre(StartsWith("second: caution: ")));
}

}  // namespace
}  // namespace tumble::scenarios
