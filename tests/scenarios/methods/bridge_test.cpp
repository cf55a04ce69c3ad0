// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"

#include "scenarios/methods/synthetic_recording.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Bridge, SamplesKeepTimeRateForceAndOrder) {
  const sim::Recording recording = testing::synthetic_rig();
  const sim::ImuRecord& record = recording.sensors.imus.front();
  std::vector<ImuSample> samples;
  ASSERT_TRUE(bridge::imu_samples(record, samples).ok());
  ASSERT_EQ(samples.size(), record.time_ns.size());
  ASSERT_GT(samples.size(), 1000u);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(samples[k].time_ns, record.time_ns[k]);
    EXPECT_EQ(samples[k].angular_velocity_rad_s, record.gyro_rad_s[k]);
    EXPECT_EQ(samples[k].specific_force_m_s2, record.accel_m_s2[k]);
  }
}

TEST(Bridge, SpecificForceAtRestPointsUp) {
  const sim::Recording recording = testing::synthetic_rig();
  std::vector<ImuSample> samples;
  ASSERT_TRUE(bridge::primary_imu_samples(recording.sensors, samples).ok());
  const Matrix3d R_WI = (recording.truth.q_WB.front() * recording.sensors.imus.front().T_BI.linear()).matrix();
  const Vector3d force_W = R_WI * samples.front().specific_force_m_s2;
  EXPECT_NEAR(force_W.z(), 9.80665, 1e-12);
  EXPECT_NEAR(force_W.head<2>().norm(), 0.0, 1e-12);
}

TEST(Bridge, EachClipBitBecomesItsOwnFlag) {
  const std::vector<std::uint8_t> expected = {kClipGyroX,  kClipGyroY,  kClipGyroZ,
                                              kClipAccelX, kClipAccelY, kClipAccelZ};
  for (std::size_t bit = 0; bit < 6; ++bit) {
    sim::Recording recording = testing::synthetic_rig();
    sim::ImuRecord& record = recording.sensors.imus.front();
    record.clip_flags[3] = static_cast<std::uint8_t>(1u << bit);
    std::vector<ImuSample> samples;
    ASSERT_TRUE(bridge::imu_samples(record, samples).ok());
    EXPECT_EQ(samples[3].device_clip_flags, expected[bit]) << "bit " << bit;
    EXPECT_EQ(samples[4].device_clip_flags, 0);
  }
}

TEST(Bridge, WhatNoDeviceOfThatRangeMeasuresIsRefusedWithItsValue) {
  sim::Recording recording = testing::synthetic_rig();
  sim::ImuRecord& record = recording.sensors.imus.front();
  std::vector<ImuSample> samples;
  record.gyro_rad_s[40].y() = -1.4 * record.stated_gyro_range_rad_s;  // a saturation limit above the stated range
  EXPECT_TRUE(bridge::imu_samples(record, samples).ok());
  const std::vector<Vector3d> read = record.gyro_rad_s;
  for (std::size_t k = 40; k < 90; ++k) record.gyro_rad_s[k].y() = -3e5;
  const Status gyro = bridge::imu_samples(record, samples);
  EXPECT_EQ(gyro.error_code, ErrorCode::out_of_range);
  EXPECT_EQ(gyro.value, 3e5);
  EXPECT_EQ(gyro.bound, 2.0 * record.stated_gyro_range_rad_s);
  EXPECT_TRUE(samples.empty());
  record.gyro_rad_s = read;
  for (std::size_t k = 7; k < 13; ++k) record.accel_m_s2[k].x() = 1e4;  // lasts longer than five samples
  EXPECT_EQ(bridge::imu_samples(record, samples).value, 1e4);
  record.stated_accel_range_m_s2 = 0.0;  // no range is stated
  EXPECT_TRUE(bridge::imu_samples(record, samples).ok());
}

TEST(Bridge, ASingleReadingThatNoDeviceOfThatRangeMeasuresIsLeftOut) {
  sim::Recording recording = testing::synthetic_rig();
  sim::ImuRecord& record = recording.sensors.imus.front();
  record.gyro_rad_s[40].y() = -3e5;
  record.accel_m_s2[70].x() = 1e4;
  std::vector<ImuSample> samples;
  ASSERT_TRUE(bridge::imu_samples(record, samples).ok());
  ASSERT_EQ(samples.size() + 2, record.time_ns.size());
  EXPECT_EQ(samples[39].time_ns, record.time_ns[39]);
  EXPECT_EQ(samples[40].time_ns, record.time_ns[41]);
}

// the test checks the lever arm's frame and sign together: a body that turns at a steady rate about its centre of mass,
// weightless, shows the force w x (w x t) at the IMU, which points from the IMU to the axis
TEST(Bridge, LeverArmGivesTheCentripetalForceInImuAxes) {
  const sim::Recording recording = testing::synthetic_rig();
  const sim::ImuRecord& record = recording.sensors.imus.front();
  const Vector3d t = bridge::lever_arm_I_m(record);
  EXPECT_NEAR((record.T_BI.linear() * t - record.T_BI.translation()).norm(), 0.0, 1e-15);
  const Vector3d w_B(1.0, -12.0, 5.0);
  const Vector3d force_B = w_B.cross(w_B.cross(record.T_BI.translation()));
  const Vector3d force_I = record.T_BI.linear().transpose() * force_B;
  const Vector3d e = record.T_BI.linear().transpose() * w_B.normalized();
  const Vector3d l = t.dot(e) * e - t;
  EXPECT_NEAR(force_I.dot(l.normalized()), l.norm() * w_B.squaredNorm(), 1e-12);
  // negative control: with the lever arm in body axes the equation does not hold
  const Vector3d wrong = record.T_BI.translation().dot(e) * e - record.T_BI.translation();
  EXPECT_GT(std::abs(force_I.dot(wrong.normalized()) - wrong.norm() * w_B.squaredNorm()), 0.5);
}

TEST(Bridge, LidarPointsFallOnTheTrueSurfaceThroughT_IL) {
  const sim::Recording recording = testing::synthetic_rig();
  const sim::LidarRecord& lidar = recording.sensors.lidars.front();
  const sim::ImuRecord& imu = recording.sensors.imus.front();
  ASSERT_EQ(bridge::sweep_count(lidar), 60u);
  const testing::SyntheticMotion motion;
  const Isometry3d T_IL = bridge::T_IL(imu, lidar);
  for (const std::size_t index : {0u, 25u, 59u}) {
    const bridge::Sweep sweep = bridge::sweep(lidar, index);
    EXPECT_EQ(sweep.end_ns - sweep.start_ns, 100000000);
    ASSERT_GT(sweep.points.size(), 500u);
    for (std::size_t k = 0; k < sweep.points.size(); k += 97) {
      const double t = 1e-9 * static_cast<double>(sweep.start_ns + sweep.points[k].offset_ns);
      const Isometry3d T_WI = Eigen::Translation3d(motion.position_m(t)) * motion.attitude(t) * imu.T_BI;
      const Vector3d hit = T_WI * T_IL * sweep.points[k].position_L_m.cast<double>();
      const Vector3f truth = recording.truth.lidars.front().hit_W_m[lidar.sweep_first[index] + k];
      // float32 coordinates of up to 7 m have a resolution of 5e-7 m
      EXPECT_NEAR((hit - truth.cast<double>()).norm(), 0.0, 3e-6);
    }
  }
}

TEST(Bridge, ASweepEndsWhereTheNextBegins) {
  sim::LidarRecord lidar = testing::synthetic_rig().sensors.lidars.front();
  const bridge::Sweep whole = bridge::sweep(lidar, 7);
  lidar.sweep_start_ns[8] -= 20;
  const bridge::Sweep sweep = bridge::sweep(lidar, 7);
  EXPECT_EQ(sweep.end_ns, whole.end_ns - 20);
  EXPECT_EQ(sweep.points.size(), whole.points.size());
  // a sweep shortened by a millisecond loses the points measured in that millisecond, a hundredth of all
  lidar.sweep_start_ns[8] -= 1'000'000;
  const bridge::Sweep shorter = bridge::sweep(lidar, 7);
  EXPECT_LT(shorter.points.size(), whole.points.size());
  EXPECT_GT(shorter.points.size(), 98 * whole.points.size() / 100);
  for (const LidarPoint& point : shorter.points) EXPECT_LE(point.offset_ns, shorter.end_ns - shorter.start_ns);
  // a point beyond the end by no more than rounding stays, with the time of the end
  const std::size_t last = lidar.sweep_first[8] - 1;
  lidar.offset_ns[last] = static_cast<std::uint32_t>(shorter.end_ns - shorter.start_ns + 200);
  const bridge::Sweep rounded = bridge::sweep(lidar, 7);
  EXPECT_EQ(rounded.points.back().position_L_m, lidar.position_L_m[last]);
  EXPECT_EQ(rounded.points.back().offset_ns, rounded.end_ns - rounded.start_ns);
  // a gap between two sweeps lengthens neither of them
  lidar.sweep_start_ns[8] += 20'000'000;
  EXPECT_EQ(bridge::sweep(lidar, 7).end_ns, whole.end_ns);
}

TEST(Bridge, NoiseVarianceIsDensitySquaredOverPeriod) {
  sim::ImuRecord record;
  record.gyro_noise_rad_s_sqrt_hz = 5.236e-4;  // 0.03 deg/s/sqrt(Hz)
  record.period_ns = 10000000;
  EXPECT_NEAR(bridge::gyro_variance_rad2_s2(record), 2.741e-5, 2e-8);
}

TEST(Bridge, OneFaultyReadingCostsOneReading) {
  const sim::ImuRecord good = testing::synthetic_rig().sensors.imus.front();
  const auto expect_one_less = [&](auto&& spoil) {
    sim::ImuRecord record = good;
    spoil(record);
    std::vector<ImuSample> samples;
    EXPECT_TRUE(bridge::imu_samples(record, samples).ok());
    EXPECT_EQ(samples.size() + 1, good.time_ns.size());
    const std::vector<bool> inlier = bridge::find_inliers(record);
    EXPECT_EQ(std::count(inlier.begin(), inlier.end(), false), 1);
    // an online estimator receives the faulty sample as well, in the order of recording
    bridge::DeliveredSamples delivered;
    EXPECT_TRUE(bridge::delivered_samples(record, delivered).ok());
    EXPECT_EQ(delivered.samples.size(), good.time_ns.size());
    EXPECT_TRUE(std::ranges::is_sorted(delivered.arrival_ns));
    EXPECT_EQ(delivered.arrival_ns.front(), inlier.front() ? good.time_ns[0] : good.time_ns[1]);
    EXPECT_EQ(delivered.arrival_ns.back(), good.time_ns.back());
  };
  expect_one_less([](sim::ImuRecord& r) { r.gyro_rad_s[7].y() = kNaN; });
  expect_one_less([](sim::ImuRecord& r) { r.accel_m_s2[7].z() = 1e7; });
  expect_one_less([](sim::ImuRecord& r) { r.time_ns[7] = r.time_ns[6]; });
  expect_one_less([](sim::ImuRecord& r) { r.time_ns[7] = r.time_ns[3]; });
  expect_one_less([](sim::ImuRecord& r) { r.time_ns[7] = r.time_ns.back(); });
  expect_one_less([](sim::ImuRecord& r) { r.time_ns[0] = std::numeric_limits<std::int64_t>::min(); });
}

TEST(Bridge, TroubleIsNamedAndLeavesNothing) {
  const sim::Recording good = testing::synthetic_rig();
  std::vector<ImuSample> samples;
  const auto status_of = [&](auto&& spoil) {
    sim::ImuRecord record = good.sensors.imus.front();
    spoil(record);
    const Status status = bridge::imu_samples(record, samples);
    EXPECT_EQ(samples.size(), 0u);
    return status;
  };
  const auto every_10 = [&](auto&& spoil) {
    return status_of([&](sim::ImuRecord& r) {
      for (std::size_t k = 7; k < r.time_ns.size(); k += 10) spoil(r, k);
    });
  };
  EXPECT_EQ(every_10([](sim::ImuRecord& r, std::size_t k) { r.gyro_rad_s[k].y() = kNaN; }).error_code,
            ErrorCode::non_finite);
  EXPECT_EQ(every_10([](sim::ImuRecord& r, std::size_t k) { r.accel_m_s2[k].z() = kNaN; }).error_code,
            ErrorCode::non_finite);
  EXPECT_EQ(every_10([](sim::ImuRecord& r, std::size_t k) { r.time_ns[k] = r.time_ns[k - 1]; }).error_code,
            ErrorCode::time_order);
  EXPECT_EQ(status_of([](sim::ImuRecord& r) {
              for (std::size_t k = 7; k < r.time_ns.size(); ++k) r.time_ns[k] += 1000000001;
            }).error_code,
            ErrorCode::gap);
  sim::Sensors none;
  EXPECT_EQ(bridge::primary_imu_samples(none, samples).error_code, ErrorCode::empty);
  sim::ImuRecord short_record = good.sensors.imus.front();
  short_record.gyro_rad_s.pop_back();
  EXPECT_THROW(bridge::imu_samples(short_record, samples), BadInput);
  sim::LidarRecord lidar = good.sensors.lidars.front();
  lidar.offset_ns.pop_back();
  EXPECT_THROW(bridge::sweep_count(lidar), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
