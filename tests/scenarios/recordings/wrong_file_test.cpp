// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <vector>

#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// WrongFile has a sound recording that each test changes with the HDF5 library, as a foreign program would.
class WrongFile : public fixture::Folder {
 protected:
  WrongFile() : path_(folder_ / "a.h5") {
    const sim::Recording recording = fixture::recording();
    write_recording(path_, fixture::info(), recording.sensors, &recording.truth);
    file_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  }
  ~WrongFile() override {
    if (file_ >= 0) H5Fclose(file_);
  }
  void close() { H5Fclose(std::exchange(file_, -1)); }

  void remove(const char* name) { ASSERT_GE(H5Ldelete(file_, name, H5P_DEFAULT), 0) << name; }
  void remove_attribute(const char* object, const char* name) {
    ASSERT_GE(H5Adelete_by_name(file_, object, name, H5P_DEFAULT), 0) << name;
  }
  /// Replaces a dataset by one that was never written.
  void replace(const char* name, hid_t type, std::vector<hsize_t> extent, const void* data = nullptr) {
    remove(name);
    const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const hid_t dataset = H5Dcreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(dataset, 0);
    if (data != nullptr) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(dataset);
    H5Sclose(space);
  }
  template <class Number>
  void put_attribute(const char* object, const char* name, hid_t type, Number value) {
    remove_attribute(object, name);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate_by_name(file_, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(H5Awrite(attribute, type, &value), 0);
    H5Aclose(attribute);
    H5Sclose(space);
  }
  std::string sensors_complaint() {
    close();
    return fixture::complaint([&] { read_sensors(path_); });
  }
  std::string truth_complaint() {
    close();
    return fixture::complaint([&] { read_truth(path_); });
  }
  std::string info_complaint() {
    close();
    return fixture::complaint([&] { read_info(path_); });
  }

  std::filesystem::path path_;
  hid_t file_ = -1;
};

TEST_F(WrongFile, AnUntouchedOneIsAccepted) {
  EXPECT_EQ(sensors_complaint(), "");
  EXPECT_EQ(fixture::complaint([&] { read_truth(path_); }), "");
}

TEST_F(WrongFile, AbsentForeignOrFolder) {
  close();
  const auto complaint_of = [](const std::filesystem::path& path) {
    return fixture::complaint([&] { read_sensors(path); });
  };
  EXPECT_EQ(complaint_of(folder_ / "none.h5"), (folder_ / "none.h5").string() + ": no such file");
  EXPECT_THAT(complaint_of(folder_),
              HasSubstr(": the path is a folder, but must be a recording (FILE.h5); 'tumble import "));
  fixture::put(folder_ / "text.h5", "scenario: hill\n");
  EXPECT_THAT(complaint_of(folder_ / "text.h5"),
              HasSubstr("text.h5: the file is truncated, damaged or not an HDF5 file"));
  const hid_t foreign = H5Fcreate((folder_ / "foreign.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(foreign);
  EXPECT_THAT(complaint_of(folder_ / "foreign.h5"), HasSubstr("foreign.h5: /format: the file is not a recording"));
}

TEST_F(WrongFile, WhatImportConvertsIsNamed) {
  const auto complaint_of = [&](const char* name, const std::string& bytes) {
    fixture::put(folder_ / name, bytes);
    return fixture::complaint([&] { read_sensors(folder_ / name); });
  };
  const std::string way = ", but must be a recording (FILE.h5); 'tumble import " + (folder_ / "a").string();
  EXPECT_THAT(complaint_of("a.bag", "#ROSBAG V2.0\n"), HasSubstr("is a ROS 1 bag" + way + ".bag -o FILE.h5'"));
  EXPECT_THAT(complaint_of("a.mcap", "\x89MCAP0\r\n"), HasSubstr("is an MCAP file" + way));
  EXPECT_THAT(complaint_of("a.h5", "#ROSBAG V2.0\n"), HasSubstr("is a ROS 1 bag")) << "whatever its name";
  EXPECT_THAT(complaint_of("a.db3", "SQLite format 3\0"), HasSubstr("is a ROS 2 bag (SQLite)" + way));
  EXPECT_THAT(complaint_of("a.csv", "time,wx\n"), HasSubstr("is a table" + way));
}

TEST_F(WrongFile, AnotherVersion) {
  put_attribute("/", "format_version", H5T_NATIVE_INT64, std::int64_t{2});
  EXPECT_EQ(
      info_complaint(),
      path_.string() +
          ": /format_version: the version of the recording format is 2; this build of tumble reads only version 1");
  EXPECT_THAT(fixture::complaint([&] { read_sensors(path_); }), HasSubstr("this build of tumble reads only version 1"));
  EXPECT_THAT(fixture::complaint([&] { read_truth(path_); }), HasSubstr("this build of tumble reads only version 1"));
}

TEST_F(WrongFile, MissingDataset) {
  remove("sensors/imus/1/gyro_I_rad_s");
  EXPECT_EQ(sensors_complaint(), path_.string() + ": /sensors/imus/1/gyro_I_rad_s: dataset is missing");
  EXPECT_EQ(fixture::complaint([&] { read_truth(path_); }), "") << "the truth is a group of its own";
}

TEST_F(WrongFile, MissingTruthDataset) {
  remove("truth/contacts/normal_W");
  EXPECT_EQ(truth_complaint(), path_.string() + ": /truth/contacts/normal_W: dataset is missing");
  EXPECT_EQ(fixture::complaint([&] { read_sensors(path_); }), "") << "the sensors never look at the truth";
}

TEST_F(WrongFile, MissingGroupOrAttribute) {
  remove_attribute("sensors/imus/0", "period_ns");
  EXPECT_EQ(sensors_complaint(), path_.string() + ": /sensors/imus/0/period_ns: attribute is missing");
}

TEST_F(WrongFile, AGapInTheNumbersOfSensors) {
  remove("sensors/imus/0");
  EXPECT_THAT(sensors_complaint(), HasSubstr("/sensors/imus/0: is missing"));
}

TEST_F(WrongFile, WrongShape) {
  replace("sensors/imus/0/gyro_I_rad_s", H5T_NATIVE_DOUBLE, {70, 4});
  EXPECT_THAT(sensors_complaint(), HasSubstr("/sensors/imus/0/gyro_I_rad_s: the dataset must have the shape N x 3"));
}

TEST_F(WrongFile, WrongNumberOfDimensions) {
  replace("sensors/imus/0/time_ns", H5T_NATIVE_INT64, {70, 1});
  EXPECT_THAT(sensors_complaint(), HasSubstr("time_ns: the dataset must have the shape N"));
}

TEST_F(WrongFile, WrongTypeOfNumber) {
  replace("sensors/imus/0/gyro_I_rad_s", H5T_NATIVE_FLOAT, {70, 3});
  EXPECT_THAT(sensors_complaint(), HasSubstr("gyro_I_rad_s: must hold float64"));
}

TEST_F(WrongFile, UnsignedTimes) {
  replace("sensors/imus/0/time_ns", H5T_NATIVE_UINT64, {70});
  EXPECT_THAT(sensors_complaint(), HasSubstr("time_ns: must hold int64"));
}

TEST_F(WrongFile, ADatasetThatWasNeverWrittenIsNotZeros) {
  replace("sensors/imus/0/gyro_I_rad_s", H5T_NATIVE_DOUBLE, {70, 3});
  EXPECT_THAT(sensors_complaint(), HasSubstr("states 70 rows, which is more than the file contains"));
}

TEST_F(WrongFile, AHugeClaimAsksForNoMemory) {
  replace("sensors/lidars/0/range_m", H5T_NATIVE_FLOAT, {hsize_t{1} << 60});
  EXPECT_THAT(sensors_complaint(), HasSubstr("which is more than the file contains"));
}

TEST_F(WrongFile, DifferingLengths) {
  const std::vector<std::uint8_t> flags(69, 0);
  replace("sensors/imus/0/clip_flags", H5T_NATIVE_UINT8, {69}, flags.data());
  EXPECT_EQ(sensors_complaint(),
            path_.string() + ": sensors/imus/0: clip_flags has 69 rows, but time_ns has 70; the numbers must be equal");
}

TEST_F(WrongFile, FallingSweepFirst) {
  const std::array<std::uint64_t, 4> first = {0, 100, 50, 150};
  replace("sensors/lidars/0/sweep_first", H5T_NATIVE_UINT64, {4}, first.data());
  EXPECT_EQ(sensors_complaint(), path_.string() + ": sensors/lidars/0: sweep_first decreases");
}

TEST_F(WrongFile, ContactsOfDifferentLength) {
  const std::array<double, 2> force = {1.0, 2.0};
  replace("truth/contacts/normal_force_n", H5T_NATIVE_DOUBLE, {2}, force.data());
  EXPECT_THAT(truth_complaint(), HasSubstr("truth/contacts: all datasets of the contacts must have the same length"));
}

TEST_F(WrongFile, ChangedReadingsDoNotFitTheDigest) {
  put_attribute("sensors", "gravity_m_s2", H5T_NATIVE_DOUBLE, 9.0);
  EXPECT_THAT(sensors_complaint(), HasSubstr("damaged or was changed"));
}

TEST_F(WrongFile, OthersNeedNotWriteADigest) {
  put_attribute("sensors", "gravity_m_s2", H5T_NATIVE_DOUBLE, 9.0);
  remove_attribute("sensors", "digest");
  EXPECT_EQ(sensors_complaint(), "");
  EXPECT_EQ(read_sensors(path_).gravity_m_s2, 9.0);
}

TEST_F(WrongFile, AttributesOfTheWrongKind) {
  put_attribute("sensors/imus/0", "period_ns", H5T_NATIVE_DOUBLE, 2.5e6);
  EXPECT_THAT(sensors_complaint(), HasSubstr("/sensors/imus/0/period_ns: the attribute must be an integer"));
}

TEST_F(WrongFile, NegativeSeed) {
  put_attribute("/", "seed", H5T_NATIVE_INT64, std::int64_t{-1});
  EXPECT_THAT(info_complaint(), HasSubstr("/seed: the HDF5 attribute is negative, but must be at least 0"));
}

TEST_F(WrongFile, TextOfVariableLengthIsRead) {
  remove_attribute("sensors", "digest");
  remove_attribute("sensors", "robot");
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute =
      H5Acreate_by_name(file_, "sensors", "robot", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const char* const text = "rig";
  H5Awrite(attribute, type, &text);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  EXPECT_EQ(sensors_complaint(), "");
  EXPECT_EQ(read_sensors(path_).robot, "rig");
}

// Without this check, the library would print its error stack to standard error.
TEST_F(WrongFile, NothingIsPrinted) {
  remove("sensors/imus/1/gyro_I_rad_s");
  testing::internal::CaptureStderr();
  const std::string message = sensors_complaint();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(message, "");
}

}  // namespace
}  // namespace tumble::scenarios
