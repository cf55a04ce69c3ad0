// SPDX-License-Identifier: BSD-3-Clause
// The test checks what a lidar that turns in a room reveals about a gyro with wrong units, axes, mountings and clocks.
#include "scenarios/diagnosis/lidar_rotation.hpp"

#include "scenarios/recordings/repairable.hpp"
#include "tests/scenarios/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::int64_t kSweep_ns = 100'000'000, kSample_ns = 2'500'000;
constexpr double kDegrees = 57.29577951308232;

/// Returns the rate of the body, whose axes are those of IMU and lidar: it turns about all three, with sizes that rise
/// and fall. `haste` multiplies the frequency of the rate.
Vector3d rate_at(double time_s, double haste = 1.0) {
  const double t = haste * time_s;
  return {0.5 * std::sin(1.3 * t), 0.4 * std::sin(1.9 * t + 1.0), 0.6 * std::cos(0.8 * t)};
}

sim::ImuRecord gyro(double length_s, double haste = 1.0) {
  sim::ImuRecord imu;
  imu.name = "imu";
  imu.period_ns = kSample_ns;
  for (std::int64_t t = kSample_ns; t < static_cast<std::int64_t>(1e9 * length_s); t += kSample_ns) {
    imu.time_ns.push_back(t);
    const std::int64_t middle_ns = t - kSample_ns / 2;
    imu.gyro_rad_s.push_back(rate_at(1e-9 * static_cast<double>(middle_ns), haste));
  }
  return imu;
}

/// Returns attitudes of the body in the world every millisecond.
std::vector<Quaterniond> attitudes(double length_s, double haste = 1.0) {
  std::vector<Quaterniond> out{Eigen::Quaterniond::Identity()};
  for (int k = 0; k < static_cast<int>(1000.0 * length_s); ++k)
    out.push_back((out.back() * so3::exp(Vector3d(1e-3 * rate_at(1e-3 * k + 5e-4, haste)))).normalized());
  return out;
}

/// Returns the range from inside a room of 8 x 6 x 3 m with an upright beam, along a unit ray.
double range_in_room(const Vector3d& ray) {
  const Vector3d half(4.0, 3.0, 1.5), at(0.7, -0.4, 0.2);
  double range = 1e9;
  for (int i = 0; i < 3; ++i) {
    if (ray[i] != 0.0) range = std::min(range, (std::copysign(half[i], ray[i]) - at[i]) / ray[i]);
  }
  const double to_beam = (2.5 - at.x()) / ray.x(), y = at.y() + to_beam * ray.y();
  return ray.x() > 0.0 && y > 0.5 && y < 1.3 ? std::min(range, to_beam) : range;
}

sim::LidarRecord lidar_in_room(std::size_t sweeps, double haste = 1.0) {
  sim::LidarRecord lidar;
  lidar.name = "lidar";
  lidar.sweep_period_ns = kSweep_ns;
  lidar.sweep_first = {0};
  const auto q_WL = attitudes(0.1 * static_cast<double>(sweeps + 1), haste);
  for (std::size_t k = 0; k < sweeps; ++k) {
    lidar.sweep_start_ns.push_back(static_cast<std::int64_t>(k) * kSweep_ns);
    for (int column = 0; column < 180; ++column) {
      for (int ring = 0; ring < 16; ++ring) {
        const double azimuth = 2.0 * M_PI * column / 180.0, elevation = (4.0 * ring - 30.0) / kDegrees;
        const Vector3d ray_L(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));
        const auto at_ms = k * 100 + static_cast<std::size_t>(column) * 100 / 180;
        const double range = range_in_room(q_WL[at_ms] * ray_L);
        lidar.position_L_m.push_back((range * ray_L).cast<float>());
        lidar.range_m.push_back(static_cast<float>(range));
        lidar.intensity.push_back(0.5F);
        lidar.offset_ns.push_back(static_cast<std::uint32_t>(column * (kSweep_ns / 180)));
        lidar.ring.push_back(static_cast<std::uint16_t>(ring));
      }
    }
    lidar.sweep_first.push_back(lidar.position_L_m.size());
  }
  return lidar;
}

/// Returns the rotations that a lidar without error would measure from sweep to sweep.
std::vector<SeenRotation> exact_rotations(int pairs) {
  const auto q_WL = attitudes(0.1 * (pairs + 1));
  std::vector<SeenRotation> out;
  for (std::size_t k = 0; k < static_cast<std::size_t>(pairs); ++k) {
    const auto at_ns = static_cast<std::int64_t>(k) * kSweep_ns;
    out.push_back(
        {at_ns, at_ns + kSweep_ns, so3::logarithm(Quaterniond(q_WL[100 * k].conjugate() * q_WL[100 * (k + 1)]))});
  }
  return out;
}

std::string text_of(const std::function<void(sim::ImuRecord&, sim::LidarRecord&)>& change,
                    GyroUnit unit = GyroUnit::rad_s) {
  sim::ImuRecord imu = gyro(8.0);
  sim::LidarRecord lidar;
  change(imu, lidar);
  const auto found = rotation_agreement(imu, lidar, exact_rotations(60));
  return found ? agreement_text("bag: 'imu'", *found, unit, 0.0) : "nothing told";
}

std::string with_gyro(const Matrix3d& matrix, GyroUnit unit = GyroUnit::rad_s) {
  return text_of(
      [&](sim::ImuRecord& imu, sim::LidarRecord&) {
        for (Vector3d& rate : imu.gyro_rad_s) rate = matrix * rate;
      },
      unit);
}

TEST(LidarRotation, WhatAgreesSaysSo) {
  EXPECT_THAT(with_gyro(Eigen::Matrix3d::Identity()),
              AllOf(HasSubstr("over 60 sweep pairs"), HasSubstr("units, signs and axes agree")));
}

TEST(LidarRotation, DegreesAreRefusedWithTheOptionThatTakesThem) {
  const Matrix3d degrees = kDegrees * Eigen::Matrix3d::Identity();
  try {
    with_gyro(-degrees);
    FAIL() << "degrees per second were taken for radians";
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("bag: 'imu'"), HasSubstr("the ratio of lidar rotation to gyro rotation is 0.0175"),
                      HasSubstr("set '--gyro-unit deg/s'")));
  }
  EXPECT_THROW(with_gyro(Eigen::Matrix3d::Identity() / kDegrees, GyroUnit::deg_s), BadInput);
  EXPECT_THAT(with_gyro(degrees, GyroUnit::deg_s), HasSubstr("caution: if the gyro is read in deg/s"));
}

TEST(LidarRotation, FlippedAndPermutedAxesAreNamed) {
  const Matrix3d flipped = Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  EXPECT_THAT(with_gyro(flipped),
              AllOf(HasSubstr("caution: the axes of the IMU are mirrored (left-handed): the sign of "
                              "the x axis is wrong"),
                    HasSubstr("No rotation and no option repairs mirrored axes")));
  const Matrix3d turned = Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  EXPECT_THAT(with_gyro(turned), AllOf(HasSubstr("(-x, -y, z)"), Not(HasSubstr("mirrored"))));
  EXPECT_THAT(with_gyro(-Eigen::Matrix3d::Identity()), HasSubstr("(-x, -y, -z)"));
  Matrix3d swapped;
  swapped << 0, 1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_THAT(with_gyro(swapped), HasSubstr("(y, x, z)"));
}

TEST(LidarRotation, AMountingThatIsTurnedIsGivenAsARotation) {
  const std::string text = text_of([](sim::ImuRecord&, sim::LidarRecord& lidar) {
    lidar.T_BL.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  });
  EXPECT_THAT(text,
              AllOf(HasSubstr("caution"), HasSubstr("0.343"), HasSubstr("0.939"), HasSubstr("Check the mounting")));
  // both sensors agree, so there is nothing to report
  EXPECT_THAT(text_of([](sim::ImuRecord& imu, sim::LidarRecord& lidar) {
                imu.T_BI.linear() = lidar.T_BL.linear() =
                    Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
              }),
              HasSubstr("units, signs and axes agree"));
}

TEST(LidarRotation, AnotherClockIsReported) {
  const auto shifted = [](std::int64_t by_ns) {
    return text_of([&](sim::ImuRecord& imu, sim::LidarRecord&) {
      for (std::int64_t& time : imu.time_ns) time -= by_ns;
    });
  };
  EXPECT_THAT(shifted(200'000'000), AllOf(HasSubstr("caution"), HasSubstr("0.2 s later"), HasSubstr("axes agree"),
                                          HasSubstr("set '--imu-minus-lidar-clock -0.2'")));
  EXPECT_THAT(shifted(-200'000'000), HasSubstr("0.2 s earlier"));
  EXPECT_THAT(shifted(10'000'000), Not(HasSubstr("caution")));
}

TEST(LidarRotation, WithoutEvidenceNothingIsReported) {
  const auto dead = [](sim::ImuRecord& imu, sim::LidarRecord&) {
    for (Vector3d& rate : imu.gyro_rad_s) rate.setZero();
  };
  EXPECT_EQ(text_of(dead), "nothing told");
  const auto other = [](sim::ImuRecord& imu, sim::LidarRecord&) {  // the same sizes, but another motion
    for (std::size_t k = 0; k < imu.gyro_rad_s.size(); ++k)
      imu.gyro_rad_s[k] = so3::exp(Vector3d(0.0, 0.011 * static_cast<double>(k), 0.7)) * imu.gyro_rad_s[k];
  };
  EXPECT_EQ(text_of(other), "nothing told");
  EXPECT_FALSE(rotation_agreement(gyro(8.0), {}, exact_rotations(11)));
  const auto late = [](sim::ImuRecord& imu, sim::LidarRecord&) {
    for (std::int64_t& time : imu.time_ns) time += 60'000'000'000;
  };
  EXPECT_EQ(text_of(late), "nothing told");
}

TEST(LidarRotation, SweepsOfARoomCheckTheGyro) {
  Imported recording;
  recording.sensors.imus.push_back(gyro(4.0));
  recording.sensors.lidars.push_back(lidar_in_room(36));
  EXPECT_GE(seen_rotations(recording.sensors.lidars.front(), nullptr).size(), 20U);
  EXPECT_THAT(check_lidar_rotation("bag", recording, GyroUnit::rad_s).notes,
              ElementsAre(AllOf(HasSubstr("imu: the rotations of lidar and gyro agree"), HasSubstr("axes agree"))));
  for (Vector3d& rate : recording.sensors.imus.front().gyro_rad_s) rate.z() = -rate.z();
  const LidarRotationCheck mirrored = check_lidar_rotation("bag", recording, GyroUnit::rad_s);
  EXPECT_THAT(mirrored.notes, ElementsAre(HasSubstr("the sign of the z axis is wrong")));
  EXPECT_FALSE(mirrored.better_BL) << "no mounting repairs mirrored axes";
  recording.sensors.imus.clear();
  EXPECT_THAT(check_lidar_rotation("bag", recording, GyroUnit::rad_s).notes, IsEmpty());
}

// the rate of the previous sweep does not predict the rate of a hand-held lidar
TEST(LidarRotation, AChangingRateIsMeasured) {
  const sim::LidarRecord lidar = lidar_in_room(36, 5.0);
  const auto found = rotation_agreement(gyro(4.0, 5.0), lidar, seen_rotations(lidar, nullptr));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->delay_s, 0.0);
  EXPECT_LT(found->error_as_read, 0.1);
}

// zeros would be a stated position, which mapping trusts more than an unknown position
TEST(LidarRotation, AnUnknownPositionIsNotRecommendedAsZeros) {
  Imported recording;
  recording.sensors.imus.push_back(gyro(4.0));
  recording.sensors.lidars.push_back(lidar_in_room(36));
  for (Vector3d& rate : recording.sensors.imus.front().gyro_rad_s) rate = {rate.x(), -rate.z(), rate.y()};
  EXPECT_THAT(check_lidar_rotation("bag", recording, GyroUnit::rad_s).notes,
              ElementsAre(HasSubstr("(set '--T-body-lidar X Y Z 0.707")));
  recording.sensors.lidars.front().T_BL.translation().x() = 0.1;
  EXPECT_THAT(check_lidar_rotation("bag", recording, GyroUnit::rad_s).notes,
              ElementsAre(HasSubstr("(set '--T-body-lidar 0.1 0 0 0.707")));
}

TEST(LidarRotation, TheRecommendedClockOffsetIncludesTheGivenOffset) {
  Imported recording;
  recording.sensors.imus.push_back(gyro(4.0));
  recording.sensors.lidars.push_back(lidar_in_room(36));
  for (std::int64_t& time : recording.sensors.imus[0].time_ns) time -= 300'000'000;
  correct_lidar_clock(-0.1, recording);
  EXPECT_THAT(
      check_lidar_rotation("bag", recording, GyroUnit::rad_s).notes,
      ElementsAre(::testing::ContainsRegex("0\\.(19|2|21) s later.*set '--imu-minus-lidar-clock -0\\.(29|3|31)'")));
}

// without rotation, only the record stamps show the offset between the clocks
TEST(LidarRotation, ACorrectedClockNeedsNoRecordStamps) {
  Imported recording;
  recording.sensors.imus.push_back(gyro(4.0));
  recording.sensors.lidars.push_back(lidar_in_room(36));
  recording.record_shift_s = -2.0;
  for (Vector3d& rate : recording.sensors.imus[0].gyro_rad_s) rate.setZero();
  EXPECT_THROW(check_lidar_rotation("bag", recording, GyroUnit::rad_s), RepairableInput);
  correct_lidar_clock(-2.0, recording);
  EXPECT_NO_THROW(check_lidar_rotation("bag", recording, GyroUnit::rad_s));
}

// the record stamps of a bag come from one clock, so they show which header stamps come from another clock
TEST(LidarRotation, RecordStampsReplaceHeaderStampsOfAnotherClock) {
  const auto with = [](double imu_late_s, std::optional<double> record_shift_s) {
    Imported recording;
    recording.sensors.imus.push_back(gyro(4.0));
    recording.sensors.lidars.push_back(lidar_in_room(36));
    recording.record_shift_s = record_shift_s;
    for (std::int64_t& time : recording.sensors.imus[0].time_ns) time += std::llround(1e9 * imu_late_s);
    try {
      check_lidar_rotation("bag", recording, GyroUnit::rad_s);
    } catch (const RepairableInput& error) {
      return error.repair().name + " " + error.repair().value + ": " + error.what();
    }
    return std::string("no repair");
  };
  EXPECT_THAT(with(-0.3, -0.3),
              AllOf(HasSubstr("--stamps record: bag: the header stamps of 'lidar' and 'imu' do not agree: "
                              "the lidar's header stamps are 0.3 s too late"),
                    HasSubstr("The record stamps agree (set '--stamps record')")));
  EXPECT_THAT(with(2.0, 2.0), HasSubstr("the lidar's header stamps are 2 s too early"));
  EXPECT_EQ(with(-0.3, std::nullopt), "no repair") << "the user chose the stamps";
  EXPECT_EQ(with(-0.3, 0.0), "no repair") << "the record stamps are as wrong as the header stamps";
  EXPECT_EQ(with(0.0, 2.0), "no repair") << "the header stamps agree";
}

}  // namespace
}  // namespace tumble::scenarios
