// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/diagnosis/diagnosis.hpp"

#include "scenarios/diagnosis/probable_devices.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

TEST(Diagnosis, NamesTheOptionThatAMessageRecommends) {
  EXPECT_EQ(recommended_option("the rates may be in deg/s (set '--gyro-unit deg/s')"), "--gyro-unit deg/s");
  EXPECT_EQ(recommended_option("one ends before the other begins; set '--stamps record' to use the record stamps"),
            "--stamps record");
  EXPECT_EQ(recommended_option("set 'x'"), "");
  EXPECT_EQ(recommended_option("set '--stamps record"), "");
}

TEST(Diagnosis, CautionsAreFindingsAndOtherNotesAreNot) {
  const std::string notes[] = {"/imu: caution: it is read in g (set '--accel-unit m/s^2')",
                               "/lidar: ignored fields: a"};
  EXPECT_THAT(
      findings_in_notes(notes),
      ElementsAre(RecordingFinding{"/imu", "it is read in g (set '--accel-unit m/s^2')", "--accel-unit m/s^2"}));
}

sim::Sensors at_rest(double from_s, double to_s) {
  sim::Sensors sensors;
  sim::ImuRecord& imu = sensors.imus.emplace_back();
  imu.name = "imu";
  imu.period_ns = 10'000'000;
  for (std::int64_t k = 0; k < 400; ++k) {
    imu.time_ns.push_back(k * imu.period_ns);
    imu.gyro_rad_s.emplace_back(1e-3 * std::sin(static_cast<double>(k)), 0.0, 0.0);
    imu.accel_m_s2.emplace_back(0.0, 0.01 * std::cos(static_cast<double>(k)), 9.81);
    imu.clip_flags.push_back(0);
  }
  sim::LidarRecord& lidar = sensors.lidars.emplace_back();
  lidar.name = "lidar";
  lidar.sweep_period_ns = 100'000'000;
  for (double t = from_s; t < to_s; t += 0.1) lidar.sweep_start_ns.push_back(std::llround(1e9 * t));
  return sensors;
}

std::vector<std::string> evidence_of(const sim::Sensors& sensors) {
  std::vector<std::string> out;
  for (const RecordingFinding& each : findings_in_readings(sensors)) out.push_back(each.where + ": " + each.evidence);
  return out;
}

TEST(Diagnosis, ReadingsAtRestAreSound) {
  EXPECT_THAT(evidence_of(at_rest(0.0, 4.0)), IsEmpty());
}

TEST(Diagnosis, LateSensorsLossAndMotionAreFound) {
  EXPECT_THAT(evidence_of(at_rest(0.6, 4.0)), ElementsAre("lidar: this sensor starts 0.6 s after 'imu' (limit 0.5 s)"));
  sim::Sensors lossy = at_rest(0.0, 4.0);
  lossy.lidars[0].sweep_start_ns.erase(lossy.lidars[0].sweep_start_ns.begin() + 5);
  EXPECT_THAT(evidence_of(lossy), IsEmpty()) << "a single sweep";
  lossy.lidars[0].sweep_start_ns.erase(lossy.lidars[0].sweep_start_ns.begin() + 8);
  EXPECT_THAT(evidence_of(lossy),
              ElementsAre("lidar: in the recording, 2 of 40 sweeps are lost (share 5 %, limit 0.5 %); the longest gap "
                          "lasts 0.2 s"));
  sim::Sensors moving = at_rest(0.0, 4.0);
  for (std::size_t k = 0; k < 400; ++k) moving.imus[0].gyro_rad_s[k].z() = std::sin(0.1 * static_cast<double>(k));
  EXPECT_THAT(evidence_of(moving),
              ElementsAre(StartsWith("imu: the robot moves during the first second: angular rates vary")));
  sim::Sensors untimed = at_rest(0.0, 4.0);
  untimed.lidars[0].point_times = sim::PointTimes::unknown;
  EXPECT_THAT(evidence_of(untimed), ElementsAre(HasSubstr("the points have no times")));
  const std::vector<std::string> fields[] = {{"x", "y", "z", "stamp_us"}};
  EXPECT_THAT(findings_in_readings(untimed, fields).at(0).repair,
              HasSubstr("set --time-field NAME to the field that contains the point times (fields of the cloud: "
                        "x, y, z, stamp_us)"));
}

TEST(Diagnosis, SaturationIsANoteAndNoFault) {
  sim::Sensors clipped = at_rest(0.0, 4.0);
  for (std::size_t k = 200; k < 300; ++k) clipped.imus[0].gyro_rad_s[k].z() = 7.8, clipped.imus[0].clip_flags[k] = 4;
  const std::vector<RecordingFinding> found = findings_in_readings(clipped);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].evidence, StartsWith("the gyro is saturated"));
  EXPECT_FALSE(found[0].fault);
}

TEST(Diagnosis, AGyroThatSaturatesFarBelowItsStatedRangeIsNoted) {
  const auto swinging = [](double amplitude_rad_s) {
    sim::Sensors out = at_rest(0.0, 4.0);
    out.imus[0].stated_gyro_range_rad_s = 34.9;
    for (std::size_t k = 200; k < 400; ++k)
      out.imus[0].gyro_rad_s[k].z() =
          std::clamp(amplitude_rad_s * std::sin(0.07 * static_cast<double>(k - 200)), -8.7, 8.7);
    return findings_in_readings(out);
  };
  const std::vector<RecordingFinding> found = swinging(12.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].evidence, HasSubstr("(stated range: 34.9 rad/s)"));
  EXPECT_THAT(found[0].repair, StartsWith("leave out --device"));
  EXPECT_THAT(swinging(5.0), IsEmpty()) << "negative control: the gyro never saturates";
}

std::vector<DataSheet> all_sheets() {
  const DataRoot data{test::source_dir()};
  std::vector<DataSheet> out;
  for (const std::string& name : device_names(data)) out.push_back(load_data_sheet(data, name));
  return out;
}

/// Returns a lidar with 16 rings at elevations [deg] from `lowest`, `step` apart.
sim::LidarRecord lidar_with_rings(double lowest, double step, const std::string& name = "points") {
  sim::LidarRecord lidar;
  lidar.name = name;
  lidar.sweep_start_ns = {0};
  for (int k = 0; k < 16 * 50; ++k) {
    const double elevation_rad = (lowest + step * (k % 16)) * M_PI / 180.0, azimuth_rad = 0.1 * k;
    lidar.position_L_m.emplace_back(
        (5.0 * Vector3d(std::cos(elevation_rad) * std::cos(azimuth_rad),
                        std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)))
            .cast<float>());
    lidar.range_m.push_back(5.0f);
    lidar.ring.push_back(static_cast<std::uint16_t>(k % 16));
  }
  lidar.sweep_first = {0, lidar.position_L_m.size()};
  return lidar;
}

std::string device_of(const std::optional<ProbableDevice>& found) {
  return found ? found->device : "none";
}

TEST(ProbableDevices, ALidarIsDetectedFromItsRingsOrItsName) {
  const std::vector<DataSheet> sheets = all_sheets();
  const std::string by_rings = device_of(probable_lidar(lidar_with_rings(-15.0, 2.0), sheets));
  EXPECT_TRUE(by_rings == "vlp16" || by_rings == "xt16" || by_rings == "rs16") << by_rings << ": 16 rings, 2 deg apart";
  EXPECT_EQ(device_of(probable_lidar(lidar_with_rings(-10.0, 1.2), sheets)), "none");
  EXPECT_EQ(device_of(probable_lidar(lidar_with_rings(-10.0, 1.2, "Livox_Mid-360"), sheets)), "mid360");
}

TEST(ProbableDevices, AnImuIsDetectedFromItsNameUnlessItsReadingsAreBeyondItsRange) {
  const std::vector<DataSheet> sheets = all_sheets();
  sim::ImuRecord imu = at_rest(0.0, 1.0).imus[0];
  EXPECT_EQ(device_of(probable_imu(imu, sheets)), "none");
  imu.name = "livox_imu";
  EXPECT_EQ(device_of(probable_imu(imu, sheets)), "mid360_imu");
  imu.name = "ouster_imu";
  EXPECT_EQ(device_of(probable_imu(imu, sheets)), "ouster_imu");
  for (Vector3d& rate : imu.gyro_rad_s) rate.x() = 30.0;
  EXPECT_EQ(device_of(probable_imu(imu, sheets)), "none") << "the IMU inside an Ouster measures 250 deg/s";
}

}  // namespace
}  // namespace tumble::scenarios
