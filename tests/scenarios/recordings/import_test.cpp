// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kHeader = "s,ns,frame,qx,qy,qz,qw,qc,wx,wy,wz,wc,ax,ay,az,ac\n";

std::string line(const std::string& stamp, const std::string& wx = "0.25") {
  return stamp + ",imu,0,0,0,1,[-1 0 0 0 0 0 0 0 0]," + wx + ",-1e-3,3,[0 0 0 0 0 0 0 0 0],9.5,0,-0.5,[0 0 0 0 0 0 0 0 0]\n";
}

class ImportCsv : public fixture::Folder {
 protected:
  Imported import(const std::string& text) {
    fixture::put(folder_ / "run_1_xsens.csv", text);
    sim::ImuRecord device;
    device.name = "imu";
    device.device = "mti30";
    device.stated_gyro_range_rad_s = 7.854;
    device.time_ns = {1, 2, 3};  // of some other recording
    return import_imu_csv(folder_ / "run_1_xsens.csv", device);
  }
  std::string complaint_of(const std::string& text) {
    return fixture::complaint([&] { import(text); });
  }
};

TEST_F(ImportCsv, ReadsTheColumnsOfTheLayout) {
  const Imported imported = import(kHeader + line("1632000000,990000000") + line("1632000001,0") + line("1632000001,10000000"));
  ASSERT_EQ(imported.sensors.imus.size(), 1u);
  const sim::ImuRecord& imu = imported.sensors.imus[0];
  EXPECT_EQ(imu.device, "mti30");
  EXPECT_EQ(imu.stated_gyro_range_rad_s, 7.854);
  EXPECT_THAT(imu.time_ns, ElementsAre(0, 10000000, 20000000));
  EXPECT_EQ(imu.period_ns, 10000000);
  EXPECT_EQ(imu.gyro_rad_s[1], Eigen::Vector3d(0.25, -1e-3, 3.0));
  EXPECT_EQ(imu.accel_m_s2[2], Eigen::Vector3d(9.5, 0.0, -0.5));
  EXPECT_THAT(imu.clip_flags, ElementsAre(0, 0, 0));
  EXPECT_THAT(imported.info.attribution, HasSubstr("run_1_xsens.csv, first stamp 1632000000990000000 ns"));
  write_recording(folder_ / "a.h5", imported.info, imported.sensors, nullptr);
  EXPECT_EQ(read_sensors(folder_ / "a.h5").imus[0].time_ns, imu.time_ns);
}

TEST_F(ImportCsv, TakesBackWhatExportWrote) {
  const sim::Recording recording = fixture::recording();
  export_csv(recording.sensors, nullptr, folder_);
  const sim::ImuRecord& given = recording.sensors.imus[1];
  const Imported imported = import_imu_csv(folder_ / "imu_reference.csv", given);
  const sim::ImuRecord& imu = imported.sensors.imus[0];
  EXPECT_EQ(imu.gyro_rad_s, given.gyro_rad_s);
  EXPECT_EQ(imu.accel_m_s2, given.accel_m_s2);
  EXPECT_EQ(imu.period_ns, given.period_ns);
  ASSERT_EQ(imu.time_ns.size(), given.time_ns.size());
  EXPECT_EQ(imu.time_ns.back(), given.time_ns.back() - given.time_ns.front());
}

TEST_F(ImportCsv, AGapDoesNotChangeThePeriod) {
  std::string text = kHeader;
  for (const char* stamp : {"1,0", "1,10000000", "1,20000000", "1,920000000", "1,930000000"}) text += line(stamp);
  EXPECT_EQ(import(text).sensors.imus[0].period_ns, 10000000);
}

TEST_F(ImportCsv, WindowsLineEndsAreRead) {
  std::string text = kHeader + line("1,0") + line("1,10000000");
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) text.insert(at, 1, '\r');
  EXPECT_EQ(import(text).sensors.imus[0].time_ns.size(), 2u);
}

TEST_F(ImportCsv, BadInputHasFileAndLine) {
  const std::string good = kHeader + line("1,0") + line("1,10000000");
  EXPECT_EQ(complaint_of(good), "");
  EXPECT_THAT(complaint_of(""), HasSubstr("is empty"));
  EXPECT_THAT(complaint_of(kHeader), HasSubstr("holds 0 samples"));
  EXPECT_THAT(complaint_of(kHeader + line("1,0")), HasSubstr("holds 1 samples"));
  EXPECT_THAT(complaint_of(good + line("1,10000000")), HasSubstr("csv:4: stamp does not rise"));
  EXPECT_THAT(complaint_of(good + line("1,5000000")), HasSubstr("csv:4: stamp does not rise"));
  EXPECT_THAT(complaint_of(good + line("1,20000000", "nan")), HasSubstr("csv:4: column 8 is not finite"));
  EXPECT_THAT(complaint_of(good + line("1,20000000", "")), HasSubstr("csv:4: column 8 must be a number, is ''"));
  EXPECT_THAT(complaint_of(good + line("1,20000000", "0.5x")), HasSubstr("csv:4: column 8 must be a number, is '0.5x'"));
  EXPECT_THAT(complaint_of(good + line("1.5,0")), HasSubstr("csv:4: column 0 must be a whole number"));
  EXPECT_THAT(complaint_of(good + line("1,1000000000")), HasSubstr("csv:4: column 1 must be a whole number"));
  EXPECT_THAT(complaint_of(good + line("1e30,0")), HasSubstr("csv:4: column 0 must be a whole number"));
  EXPECT_THAT(complaint_of(good + "\n"), HasSubstr("csv:4: has 1 columns"));
  EXPECT_THAT(complaint_of(good + line("1,20000000").substr(0, 60)), HasSubstr("csv:4: has"));
  EXPECT_THAT(complaint_of("a,b\n1,2\n"), HasSubstr("csv:2: has 2 columns"));
  EXPECT_THAT(fixture::complaint([&] { import_imu_csv(folder_ / "none.csv", {}); }), HasSubstr("none.csv: no such file"));
  EXPECT_THAT(fixture::complaint([&] { import_imu_csv(folder_, {}); }), HasSubstr("no such file"));
}

using ImportBroad = fixture::Folder;

TEST_F(ImportBroad, ReadsATrialAndKeepsTheAttribution) {
  const std::filesystem::path trial = std::filesystem::path(TUMBLE_SHARED_DATA) / "broad/24_disturbed_tapping_A.hdf5";
  if (!std::filesystem::exists(trial)) GTEST_SKIP() << "the BROAD trials are not at " << trial;
  const Imported imported = import_broad(trial);
  ASSERT_EQ(imported.sensors.imus.size(), 1u);
  const sim::ImuRecord& imu = imported.sensors.imus[0];
  ASSERT_EQ(imu.time_ns.size(), 57746u);
  EXPECT_EQ(imu.period_ns, 3500000) << "285.714 Hz";
  EXPECT_NEAR(static_cast<double>(imu.time_ns.back()) * 1e-9, 57745 / 285.7142857, 1e-5);
  // at rest at the start: gravity, +9.8 up, and hardly a rate
  EXPECT_NEAR(imu.accel_m_s2[0].norm(), 9.81, 0.1);
  EXPECT_LT(imu.gyro_rad_s[0].norm(), 0.05);
  EXPECT_THAT(imported.info.attribution, HasSubstr("Laidig"));
  EXPECT_THAT(imported.info.attribution, HasSubstr("CC BY 4.0; trial 24_disturbed_tapping_A"));
  write_recording(folder_ / "a.h5", imported.info, imported.sensors, nullptr);
  EXPECT_EQ(read_info(folder_ / "a.h5").attribution, imported.info.attribution);
}

TEST_F(ImportBroad, OtherFilesAreRefused) {
  const sim::Recording recording = fixture::recording();
  write_recording(folder_ / "a.h5", {}, recording.sensors, nullptr);
  EXPECT_THAT(fixture::complaint([&] { import_broad(folder_ / "a.h5"); }), HasSubstr("/sampling_rate: attribute is missing"));
  fixture::put(folder_ / "b.h5", "text");
  EXPECT_THAT(fixture::complaint([&] { import_broad(folder_ / "b.h5"); }), StartsWith((folder_ / "b.h5").string()));
}

}  // namespace
}  // namespace tumble::scenarios
