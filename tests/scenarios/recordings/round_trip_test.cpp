// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <limits>

#include "scenarios/recordings/fixture_recording.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using fixture::info;
using RoundTrip = fixture::Folder;

// The digest covers every field; the comparisons of single fields below do not depend on it.
TEST_F(RoundTrip, EveryFieldComesBackExactly) {
  const sim::Recording recording = fixture::recording();
  const std::filesystem::path path = folder_ / "a.h5";
  write_recording(path, info(), recording.sensors, &recording.truth);
  EXPECT_EQ(files(), 1u) << "no temporary file stays";
  const sim::Sensors sensors = read_sensors(path);
  const sim::Truth truth = read_truth(path);
  EXPECT_EQ(digest(sensors, &truth), digest(recording.sensors, &recording.truth));

  EXPECT_EQ(sensors.robot, "sphere");
  EXPECT_EQ(sensors.sphere_radius_m, 0.145);
  EXPECT_EQ(sensors.gravity_m_s2, 9.81);
  ASSERT_EQ(sensors.imus.size(), 2u);
  const sim::ImuRecord& imu = sensors.imus[1];
  const sim::ImuRecord& given = recording.sensors.imus[1];
  EXPECT_EQ(imu.name, "imu_reference");
  EXPECT_EQ(imu.device, given.device);
  EXPECT_EQ(imu.period_ns, given.period_ns);
  EXPECT_EQ(imu.stated_gyro_range_rad_s, given.stated_gyro_range_rad_s);
  EXPECT_EQ(imu.stated_accel_range_m_s2, given.stated_accel_range_m_s2);
  EXPECT_EQ(imu.gyro_noise_rad_s_sqrt_hz, given.gyro_noise_rad_s_sqrt_hz);
  EXPECT_EQ(imu.accel_noise_m_s2_sqrt_hz, given.accel_noise_m_s2_sqrt_hz);
  EXPECT_EQ(imu.T_BI.matrix(), given.T_BI.matrix());
  EXPECT_EQ(imu.time_ns, given.time_ns);
  EXPECT_EQ(imu.gyro_rad_s, given.gyro_rad_s);
  EXPECT_EQ(imu.accel_m_s2, given.accel_m_s2);
  EXPECT_EQ(imu.clip_flags, given.clip_flags);
  EXPECT_EQ(imu.magnetic_field_t, given.magnetic_field_t);
  EXPECT_EQ(imu.earth_field_W_t, given.earth_field_W_t);
  ASSERT_EQ(sensors.lidars.size(), 1u);
  const sim::LidarRecord& lidar = sensors.lidars[0];
  const sim::LidarRecord& given_lidar = recording.sensors.lidars[0];
  EXPECT_EQ(lidar.T_BL.matrix(), given_lidar.T_BL.matrix());
  EXPECT_EQ(lidar.sweep_period_ns, given_lidar.sweep_period_ns);
  EXPECT_EQ(lidar.sweep_start_ns, given_lidar.sweep_start_ns);
  EXPECT_EQ(lidar.sweep_first, given_lidar.sweep_first);
  EXPECT_EQ(lidar.position_L_m, given_lidar.position_L_m);
  EXPECT_EQ(lidar.range_m, given_lidar.range_m);
  EXPECT_EQ(lidar.intensity, given_lidar.intensity);
  EXPECT_EQ(lidar.offset_ns, given_lidar.offset_ns);
  EXPECT_EQ(lidar.ring, given_lidar.ring);
}

TEST_F(RoundTrip, EveryFieldOfTheTruthComesBackExactly) {
  const sim::Recording recording = fixture::recording();
  const std::filesystem::path path = folder_ / "a.h5";
  write_recording(path, info(), recording.sensors, &recording.truth);
  const sim::Truth truth = read_truth(path);
  const sim::Truth& given = recording.truth;
  EXPECT_EQ(truth.period_ns, given.period_ns);
  EXPECT_EQ(truth.p_WB_m, given.p_WB_m);
  ASSERT_EQ(truth.q_WB.size(), given.q_WB.size());
  EXPECT_EQ(truth.q_WB[7].coeffs(), given.q_WB[7].coeffs());
  EXPECT_EQ(truth.v_WB_m_s, given.v_WB_m_s);
  EXPECT_EQ(truth.w_WB_B_rad_s, given.w_WB_B_rad_s);
  EXPECT_EQ(truth.f_B_m_s2, given.f_B_m_s2);
  EXPECT_EQ(truth.label, given.label);
  EXPECT_EQ(truth.p_BG_m, given.p_BG_m);
  EXPECT_EQ(truth.surfaces, given.surfaces);
  ASSERT_EQ(truth.contacts.size(), given.contacts.size());
  EXPECT_EQ(truth.contacts[5].time_ns, given.contacts[5].time_ns);
  EXPECT_EQ(truth.contacts[5].point_W_m, given.contacts[5].point_W_m);
  EXPECT_EQ(truth.contacts[5].normal_W, given.contacts[5].normal_W);
  EXPECT_EQ(truth.contacts[5].slip_velocity_W_m_s, given.contacts[5].slip_velocity_W_m_s);
  EXPECT_EQ(truth.contacts[5].normal_force_n, given.contacts[5].normal_force_n);
  EXPECT_EQ(truth.contacts[5].surface_id, given.contacts[5].surface_id);
  ASSERT_EQ(truth.imus.size(), 2u);
  EXPECT_EQ(truth.imus[1].name, "imu_reference");
  EXPECT_EQ(truth.imus[1].T_BI.matrix(), given.imus[1].T_BI.matrix());
  EXPECT_EQ(truth.imus[1].rate_rad_s, given.imus[1].rate_rad_s);
  EXPECT_EQ(truth.imus[1].specific_force_m_s2, given.imus[1].specific_force_m_s2);
  EXPECT_EQ(truth.imus[1].gyro_unclipped_rad_s, given.imus[1].gyro_unclipped_rad_s);
  EXPECT_EQ(truth.imus[1].accel_unclipped_m_s2, given.imus[1].accel_unclipped_m_s2);
  EXPECT_EQ(truth.imus[1].gyro_bias_rad_s, given.imus[1].gyro_bias_rad_s);
  EXPECT_EQ(truth.imus[1].accel_bias_m_s2, given.imus[1].accel_bias_m_s2);
  EXPECT_EQ(truth.imus[1].magnetic_field_t, given.imus[1].magnetic_field_t);
  ASSERT_EQ(truth.lidars.size(), 1u);
  EXPECT_EQ(truth.lidars[0].hit_W_m, given.lidars[0].hit_W_m);
  EXPECT_EQ(truth.lidars[0].surface_id, given.lidars[0].surface_id);
}

TEST_F(RoundTrip, WhatIsKnownOfPointTimesComesBackAndTheUsualLeavesNoTrace) {
  sim::Recording recording = fixture::recording();
  const std::filesystem::path path = folder_ / "a.h5";
  const std::string measured = digest(recording.sensors, nullptr);
  const auto has_attribute = [&] {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const htri_t has = H5Aexists_by_name(file, "sensors/lidars/0", "point_times", H5P_DEFAULT);
    H5Fclose(file);
    return has;
  };
  write_recording(path, info(), recording.sensors, nullptr);
  EXPECT_EQ(has_attribute(), 0);
  EXPECT_EQ(read_sensors(path).lidars[0].point_times, sim::PointTimes::measured);
  sim::LidarRecord& lidar = recording.sensors.lidars[0];
  lidar.offset_ns.assign(lidar.offset_ns.size(), 0);
  for (const sim::PointTimes times : {sim::PointTimes::not_skewed, sim::PointTimes::unknown}) {
    lidar.point_times = times;
    write_recording(path, info(), recording.sensors, nullptr);
    EXPECT_GT(has_attribute(), 0);
    EXPECT_EQ(read_sensors(path).lidars[0].point_times, times);
    EXPECT_NE(digest(recording.sensors, nullptr), measured);
  }
}

TEST_F(RoundTrip, SensingElementsComeBackAndUprightOnesLeaveNoTrace) {
  sim::Recording recording = fixture::recording();
  sim::ImuTruth& tilted = recording.truth.imus[1];
  tilted.gyro_elements = {{1.0, 0.02, 0.0}, {-0.01, 0.98, 0.05}, {0.0, 0.03, 1.01}};
  tilted.accel_elements = {{1.0, 0.01, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.97}};
  tilted.gyro_element_offset_rad_s = {0.05, 0.0, -0.02};
  tilted.accel_element_offset_m_s2 = {0.2, 0.1, 0.0};
  const std::filesystem::path path = folder_ / "a.h5";
  write_recording(path, info(), recording.sensors, &recording.truth);
  const sim::Truth truth = read_truth(path);
  EXPECT_EQ(truth.imus[1].gyro_elements, tilted.gyro_elements);
  EXPECT_EQ(truth.imus[1].accel_elements, tilted.accel_elements);
  EXPECT_EQ(truth.imus[1].gyro_element_offset_rad_s, tilted.gyro_element_offset_rad_s);
  EXPECT_EQ(truth.imus[1].accel_element_offset_m_s2, tilted.accel_element_offset_m_s2);
  EXPECT_TRUE(truth.imus[0].gyro_elements.empty());
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GT(H5Lexists(file, "truth/imus/1/gyro_elements_I", H5P_DEFAULT), 0);
  for (const char* name : {"gyro_elements_I", "gyro_element_offset_rad_s", "accel_elements_I"}) {
    EXPECT_EQ(H5Lexists(file, ("truth/imus/0/" + std::string(name)).c_str(), H5P_DEFAULT), 0) << name;
  }
  H5Fclose(file);
}

TEST_F(RoundTrip, AnImuWithoutMagnetometerLeavesNoTraceOfOne) {
  sim::Recording recording = fixture::recording();
  for (sim::ImuRecord& imu : recording.sensors.imus) {
    imu.magnetic_field_t.clear();
    imu.earth_field_W_t.setZero();
  }
  for (sim::ImuTruth& imu : recording.truth.imus) imu.magnetic_field_t.clear();
  const std::filesystem::path path = folder_ / "a.h5";
  write_recording(path, info(), recording.sensors, &recording.truth);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GT(H5Lexists(file, "sensors/imus/0/clip_flags", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file, "sensors/imus/0/magnetic_field_I_t", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file, "sensors/imus/0/earth_field_W_t", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file, "truth/imus/0/magnetic_field_I_t", H5P_DEFAULT), 0);
  H5Fclose(file);
  EXPECT_TRUE(read_sensors(path).imus[0].magnetic_field_t.empty());
  EXPECT_TRUE(read_truth(path).imus[0].magnetic_field_t.empty());
  EXPECT_EQ(digest(read_sensors(path), nullptr), digest(recording.sensors, nullptr));
}

TEST_F(RoundTrip, InfoComesBackAndTheWriterFillsItsOwnPart) {
  const sim::Recording recording = fixture::recording();
  RecordingInfo given = info();
  given.situation_yaml = std::string(200000, 'y');  // larger than an object header can store
  given.digest = "wrong";
  write_recording(folder_ / "a.h5", given, recording.sensors, &recording.truth);
  const RecordingInfo found = read_info(folder_ / "a.h5");
  EXPECT_EQ(found.format_version, 1);
  EXPECT_EQ(found.scenario, given.scenario);
  EXPECT_EQ(found.seed, given.seed);
  EXPECT_EQ(found.situation_yaml, given.situation_yaml);
  EXPECT_EQ(found.tumble_version, given.tumble_version);
  EXPECT_EQ(found.engine_version, given.engine_version);
  EXPECT_EQ(found.attribution, given.attribution);
  EXPECT_EQ(found.digest, digest(recording.sensors, &recording.truth));
  EXPECT_TRUE(found.has_truth);
}

TEST_F(RoundTrip, ARealRecordingHasNoTruth) {
  const sim::Recording recording = fixture::recording();
  const std::filesystem::path path = folder_ / "real.h5";
  write_recording(path, {}, recording.sensors, nullptr);
  EXPECT_FALSE(read_info(path).has_truth);
  EXPECT_EQ(read_info(path).digest, digest(read_sensors(path), nullptr));
  EXPECT_EQ(fixture::complaint([&] { read_truth(path); }),
            path.string() +
                ": the recording has no truth; only simulated recordings and recordings with a reference have truth");
}

TEST_F(RoundTrip, EmptyAndOddContentIsKept) {
  sim::Sensors sensors;
  write_recording(folder_ / "empty.h5", {}, sensors, nullptr);
  EXPECT_EQ(digest(read_sensors(folder_ / "empty.h5"), nullptr), digest(sensors, nullptr));

  fixture::Numbers numbers;
  sensors.imus.push_back(fixture::imu_record(numbers, "", 0));
  sensors.imus.push_back(fixture::imu_record(numbers, "a/b", 1));
  sensors.imus[1].gyro_rad_s[0].x() = std::numeric_limits<double>::quiet_NaN();
  sensors.imus[1].accel_m_s2[0].x() = -0.0;
  sensors.lidars.emplace_back();
  sensors.lidars.back().sweep_period_ns = 1;
  sim::Truth truth;
  truth.imus.resize(2);
  truth.imus[1] = fixture::imu_truth(numbers, "a/b", 1);
  truth.lidars.resize(1);
  write_recording(folder_ / "odd.h5", {}, sensors, &truth);
  const sim::Truth truth_back = read_truth(folder_ / "odd.h5");
  EXPECT_EQ(digest(read_sensors(folder_ / "odd.h5"), &truth_back), digest(sensors, &truth));
}

TEST_F(RoundTrip, EqualRecordingsGiveEqualFiles) {
  const sim::Recording recording = fixture::recording();
  for (const char* name : {"a.h5", "b.h5"})
    write_recording(folder_ / name, info(), recording.sensors, &recording.truth);
  EXPECT_TRUE(fixture::bytes_of(folder_ / "a.h5") == fixture::bytes_of(folder_ / "b.h5"));
  sim::Sensors other = recording.sensors;
  double& last_bit = other.imus[0].gyro_rad_s[3].x();
  last_bit = std::nextafter(last_bit, 1e9);
  write_recording(folder_ / "b.h5", info(), other, &recording.truth);
  EXPECT_FALSE(fixture::bytes_of(folder_ / "a.h5") == fixture::bytes_of(folder_ / "b.h5"));
}

TEST_F(RoundTrip, ContradictingDataAreRefusedBeforeAnyFileIsTouched) {
  sim::Recording recording = fixture::recording();
  recording.sensors.imus[0].time_ns.pop_back();
  EXPECT_THROW(write_recording(folder_ / "a.h5", info(), recording.sensors, &recording.truth), std::invalid_argument);
  EXPECT_EQ(files(), 0u);
}

/// Notes the names of all datasets under a file's root, with their attribute `unit`.
herr_t note_dataset(hid_t root, const char* name, const H5O_info_t* object, void* out) {
  if (object->type == H5O_TYPE_DATASET) {
    const htri_t has_unit = H5Aexists_by_name(root, name, "unit", H5P_DEFAULT);
    static_cast<std::vector<std::pair<std::string, bool>>*>(out)->emplace_back(name, has_unit > 0);
  }
  return 0;
}

// FORMAT.md promises that each dataset of numbers has a unit, and describes each by name.
TEST_F(RoundTrip, EveryDatasetHasAUnitAndIsDocumented) {
  const sim::Recording recording = fixture::recording();
  write_recording(folder_ / "a.h5", info(), recording.sensors, &recording.truth);
  const std::string page = fixture::bytes_of((test::source_dir() / "scenarios/recordings/FORMAT.md").string());
  std::vector<std::pair<std::string, bool>> datasets;
  const hid_t file = H5Fopen((folder_ / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, note_dataset, &datasets, H5O_INFO_BASIC);
  H5Fclose(file);
  EXPECT_EQ(datasets.size(), 2 * 7 + 8 + 8 + 6 + 2 * 8 + 3 + (2 + 2) + (1 + 2u));
  for (const auto& [name, has_unit] : datasets) {
    EXPECT_TRUE(has_unit || name == "truth/surfaces") << name;
    std::string quoted(1, '`');
    quoted.append(name.substr(name.rfind('/') + 1)).append(1, '`');
    EXPECT_NE(page.find(quoted), std::string::npos) << quoted;
  }
}

}  // namespace
}  // namespace tumble::scenarios
