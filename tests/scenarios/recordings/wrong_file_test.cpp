// SPDX-License-Identifier: BSD-3-Clause
#include <hdf5.h>

#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

void remove(hid_t file, const char* name) {
  ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0) << name;
}
void remove_attribute(hid_t file, const char* object, const char* name) {
  ASSERT_GE(H5Adelete_by_name(file, object, name, H5P_DEFAULT), 0) << name;
}
/// Replaces a dataset by another, which is never written if `data` is empty.
void replace(hid_t file, const char* name, hid_t type, std::vector<hsize_t> extent, const void* data = nullptr) {
  remove(file, name);
  const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
  const hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(dataset, 0);
  if (data != nullptr) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  H5Dclose(dataset);
  H5Sclose(space);
}
template <class Value>
void put_attribute(hid_t file, const char* object, const char* name, hid_t type, Value value) {
  remove_attribute(file, object, name);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate_by_name(file, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(H5Awrite(attribute, type, &value), 0);
  H5Aclose(attribute);
  H5Sclose(space);
}

/// WrongFile has a sound recording that each test changes with the HDF5 library, as a foreign program would.
class WrongFile : public test::TemporaryFolder {
 protected:
  WrongFile() {
    const sim::Recording recording = fixture::recording();
    write_recording(path_, fixture::info(), recording.sensors, &recording.truth);
  }
  void change(const std::function<void(hid_t)>& by) const {
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    by(file);
    H5Fclose(file);
  }
  std::string sensors_complaint() const {
    return test::complaint([&] { read_sensors(path_); });
  }
  std::string truth_complaint() const {
    return test::complaint([&] { read_truth(path_); });
  }
  std::string info_complaint() const {
    return test::complaint([&] { read_info(path_); });
  }

  const fs::path path_ = folder_ / "a.h5";
};

TEST_F(WrongFile, AnUntouchedOneIsAccepted) {
  EXPECT_EQ(sensors_complaint(), "");
  EXPECT_EQ(truth_complaint(), "");
}

TEST_F(WrongFile, AbsentForeignOrFolder) {
  const auto complaint_of = [](const fs::path& path) { return test::complaint([&] { read_sensors(path); }); };
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
    return test::complaint([&] { read_sensors(folder_ / name); });
  };
  const std::string way = ", but must be a recording (FILE.h5); 'tumble import " + (folder_ / "a").string();
  EXPECT_THAT(complaint_of("a.bag", "#ROSBAG V2.0\n"), HasSubstr("is a ROS 1 bag" + way + ".bag -o FILE.h5'"));
  EXPECT_THAT(complaint_of("a.mcap", "\x89MCAP0\r\n"), HasSubstr("is an MCAP file" + way));
  EXPECT_THAT(complaint_of("a.h5", "#ROSBAG V2.0\n"), HasSubstr("is a ROS 1 bag")) << "whatever its name";
  EXPECT_THAT(complaint_of("a.db3", "SQLite format 3\0"), HasSubstr("is a ROS 2 bag (SQLite)" + way));
  EXPECT_THAT(complaint_of("a.csv", "time,wx\n"), HasSubstr("is a table" + way));
}

TEST_F(WrongFile, AnotherVersion) {
  change([](hid_t file) { put_attribute(file, "/", "format_version", H5T_NATIVE_INT64, std::int64_t{2}); });
  EXPECT_EQ(
      info_complaint(),
      path_.string() +
          ": /format_version: the version of the recording format is 2; this build of tumble reads only version 1");
  EXPECT_THAT(sensors_complaint(), HasSubstr("this build of tumble reads only version 1"));
  EXPECT_THAT(truth_complaint(), HasSubstr("this build of tumble reads only version 1"));
}

/// A Fault is a change of the file, and the end of the message of each reader that must reject the file.
struct Fault {
  const char* name;
  void (*change)(hid_t file);
  std::string sensors, truth = "", info = "";
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

class FaultOfFile : public WrongFile, public testing::WithParamInterface<Fault> {};

TEST_P(FaultOfFile, IsRejectedByTheReadersOfThatPart) {
  change(GetParam().change);
  for (const auto& [said, expected] :
       {std::pair{sensors_complaint(), GetParam().sensors}, std::pair{truth_complaint(), GetParam().truth},
        std::pair{info_complaint(), GetParam().info}}) {
    if (expected.empty()) {
      EXPECT_EQ(said, "");
    } else {
      EXPECT_THAT(said, AllOf(StartsWith(path_.string() + ": "), HasSubstr(expected)));
    }
  }
}

const std::vector<std::uint8_t> kFlags(69, 0);
constexpr std::array<std::uint64_t, 4> kFalling = {0, 100, 50, 150};
constexpr std::array<double, 2> kForces = {1.0, 2.0};

INSTANTIATE_TEST_SUITE_P(
    , FaultOfFile,
    testing::Values(
        Fault{"MissingDataset", [](hid_t file) { remove(file, "sensors/imus/1/gyro_I_rad_s"); },
              "/sensors/imus/1/gyro_I_rad_s: dataset is missing"},
        Fault{"MissingTruthDataset", [](hid_t file) { remove(file, "truth/contacts/normal_W"); }, "",
              "/truth/contacts/normal_W: dataset is missing"},
        Fault{"MissingAttribute", [](hid_t file) { remove_attribute(file, "sensors/imus/0", "period_ns"); },
              "/sensors/imus/0/period_ns: attribute is missing"},
        Fault{"AGapInTheNumbersOfSensors", [](hid_t file) { remove(file, "sensors/imus/0"); },
              "/sensors/imus/0: is missing"},
        Fault{"WrongShape",
              [](hid_t file) {
                replace(file, "sensors/imus/0/gyro_I_rad_s", H5T_NATIVE_DOUBLE, {70, 4});
              },
              "/sensors/imus/0/gyro_I_rad_s: the dataset must have the shape N x 3"},
        Fault{"WrongNumberOfDimensions",
              [](hid_t file) {
                replace(file, "sensors/imus/0/time_ns", H5T_NATIVE_INT64, {70, 1});
              },
              "time_ns: the dataset must have the shape N"},
        Fault{"WrongTypeOfNumber",
              [](hid_t file) {
                replace(file, "sensors/imus/0/gyro_I_rad_s", H5T_NATIVE_FLOAT, {70, 3});
              },
              "gyro_I_rad_s: must hold float64"},
        Fault{"UnsignedTimes", [](hid_t file) { replace(file, "sensors/imus/0/time_ns", H5T_NATIVE_UINT64, {70}); },
              "time_ns: must hold int64"},
        Fault{"ADatasetThatWasNeverWritten",
              [](hid_t file) {
                replace(file, "sensors/imus/0/gyro_I_rad_s", H5T_NATIVE_DOUBLE, {70, 3});
              },
              "states 70 rows, which is more than the file contains"},
        Fault{"AHugeClaim",
              [](hid_t file) { replace(file, "sensors/lidars/0/range_m", H5T_NATIVE_FLOAT, {hsize_t{1} << 60}); },
              "which is more than the file contains"},
        Fault{"DifferingLengths",
              [](hid_t file) { replace(file, "sensors/imus/0/clip_flags", H5T_NATIVE_UINT8, {69}, kFlags.data()); },
              "sensors/imus/0: clip_flags has 69 rows, but time_ns has 70; the numbers must be equal"},
        Fault{
            "FallingSweepFirst",
            [](hid_t file) { replace(file, "sensors/lidars/0/sweep_first", H5T_NATIVE_UINT64, {4}, kFalling.data()); },
            "sensors/lidars/0: sweep_first decreases"},
        Fault{
            "ContactsOfDifferentLength",
            [](hid_t file) { replace(file, "truth/contacts/normal_force_n", H5T_NATIVE_DOUBLE, {2}, kForces.data()); },
            "", "truth/contacts: all datasets of the contacts must have the same length"},
        Fault{"ChangedReadings",
              [](hid_t file) { put_attribute(file, "sensors", "gravity_m_s2", H5T_NATIVE_DOUBLE, 9.0); },
              "damaged or was changed"},
        Fault{"AttributeOfTheWrongKind",
              [](hid_t file) { put_attribute(file, "sensors/imus/0", "period_ns", H5T_NATIVE_DOUBLE, 2.5e6); },
              "/sensors/imus/0/period_ns: the attribute must be an integer"},
        Fault{"NegativeSeed", [](hid_t file) { put_attribute(file, "/", "seed", H5T_NATIVE_INT64, std::int64_t{-1}); },
              "", "", "/seed: the HDF5 attribute is negative, but must be at least 0"}),
    [](const auto& fault) { return std::string(fault.param.name); });

TEST_F(WrongFile, OthersNeedNotWriteADigest) {
  change([](hid_t file) {
    put_attribute(file, "sensors", "gravity_m_s2", H5T_NATIVE_DOUBLE, 9.0);
    remove_attribute(file, "sensors", "digest");
  });
  EXPECT_EQ(sensors_complaint(), "");
  EXPECT_EQ(read_sensors(path_).gravity_m_s2, 9.0);
}

TEST_F(WrongFile, TextOfVariableLengthIsRead) {
  change([](hid_t file) {
    remove_attribute(file, "sensors", "digest");
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    put_attribute(file, "sensors", "robot", type, static_cast<const char*>("rig"));
    H5Tclose(type);
  });
  EXPECT_EQ(sensors_complaint(), "");
  EXPECT_EQ(read_sensors(path_).robot, "rig");
}

// Without this check, the library would print its error stack to standard error.
TEST_F(WrongFile, NothingIsPrinted) {
  change([](hid_t file) { remove(file, "sensors/imus/1/gyro_I_rad_s"); });
  testing::internal::CaptureStderr();
  const std::string message = sensors_complaint();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(message, "");
}

}  // namespace
}  // namespace tumble::scenarios
