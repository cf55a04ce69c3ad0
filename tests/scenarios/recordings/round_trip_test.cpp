// SPDX-License-Identifier: BSD-3-Clause
#include <hdf5.h>

#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using fixture::info;
using RoundTrip = test::TemporaryFolder;

// Digest.EveryFieldCounts shows that equal digests mean equal fields; the comparisons below do not depend on the digest
TEST_F(RoundTrip, EveryFieldComesBackExactly) {
  const sim::Recording recording = fixture::recording();
  const fs::path path = folder_ / "a.h5";
  write_recording(path, info(), recording.sensors, &recording.truth);
  EXPECT_EQ(files(), 1u) << "no temporary file stays";
  const sim::Sensors sensors = read_sensors(path);
  const sim::Truth truth = read_truth(path);
  EXPECT_EQ(digest(sensors, &truth), digest(recording.sensors, &recording.truth));
  EXPECT_EQ(sensors.imus.at(1).T_BI.matrix(), recording.sensors.imus[1].T_BI.matrix());
  EXPECT_EQ(sensors.imus[1].gyro_rad_s, recording.sensors.imus[1].gyro_rad_s);
  EXPECT_EQ(sensors.lidars.at(0).position_L_m, recording.sensors.lidars[0].position_L_m);
  EXPECT_EQ(truth.p_WB_m, recording.truth.p_WB_m);
  EXPECT_EQ(truth.imus.at(1).rate_rad_s, recording.truth.imus[1].rate_rad_s);
  EXPECT_EQ(truth.lidars.at(0).hit_W_m, recording.truth.lidars[0].hit_W_m);
}

TEST_F(RoundTrip, WhatIsKnownOfPointTimesComesBackAndTheUsualLeavesNoTrace) {
  sim::Recording recording = fixture::recording();
  const fs::path path = folder_ / "a.h5";
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
  const fs::path path = folder_ / "a.h5";
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
  const fs::path path = folder_ / "a.h5";
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
  const fs::path path = folder_ / "real.h5";
  write_recording(path, {}, recording.sensors, nullptr);
  EXPECT_FALSE(read_info(path).has_truth);
  EXPECT_EQ(read_info(path).digest, digest(read_sensors(path), nullptr));
  EXPECT_EQ(test::complaint([&] { read_truth(path); }),
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
  EXPECT_TRUE(test::read_file(folder_ / "a.h5") == test::read_file(folder_ / "b.h5"));
  sim::Sensors other = recording.sensors;
  double& last_bit = other.imus[0].gyro_rad_s[3].x();
  last_bit = std::nextafter(last_bit, 1e9);
  write_recording(folder_ / "b.h5", info(), other, &recording.truth);
  EXPECT_FALSE(test::read_file(folder_ / "a.h5") == test::read_file(folder_ / "b.h5"));
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
  const std::string page = test::read_file((test::source_dir() / "scenarios/recordings/FORMAT.md").string());
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
