// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"

namespace tumble::scenarios {
namespace {

/// Returns an ASCII sweep of points (1, 2, 3), with one more column.
std::string sweep(const std::string& column = "", const std::vector<std::string>& values = {"", "", ""}) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(values.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!column.empty()) text += "property " + column + "\n";
  text += "end_header\n";
  for (const std::string& value : values) text += "1 2 3" + (value.empty() ? "" : " " + value) + "\n";
  return text;
}

class ImportSweeps : public test::TemporaryFolder {
 protected:
  ImportSweeps() {
    source_.folder = folder_;
    source_.format = "ply";
    source_.reading.device.name = "lidar";
  }
  void put(const std::string& name, const std::string& content) { fixture::put(folder_ / name, content); }
  sim::LidarRecord import() {
    imported_ = import_sweeps(source_);
    EXPECT_EQ(imported_.sensors.lidars.size(), 1u);
    return imported_.sensors.lidars.at(0);
  }
  std::string complaint_of() {
    return test::complaint([&] { import_sweeps(source_); });
  }
  SweepSource source_;
  Imported imported_;
};

// The test checks that both formats contain all that a lidar states, to the bit. The import reads both with PCL, which
// did not write them.
TEST_F(ImportSweeps, WhatExportWritesComesBackToTheBit) {
  const sim::Recording recording = fixture::recording();
  const sim::LidarRecord& given = recording.sensors.lidars[0];
  source_.reading.device = sim::LidarRecord{};
  source_.reading.device.name = given.name;
  source_.reading.device.device = given.device;
  source_.reading.device.T_BL = given.T_BL;
  for (const std::string format : {"ply", "pcd"}) {
    source_.folder = folder_ / format;
    source_.format = format;
    format == "ply" ? export_ply(recording.sensors, source_.folder) : export_pcd(recording.sensors, source_.folder);
    sim::Sensors back;
    back.lidars = {import()};
    sim::Sensors lidar_alone;
    lidar_alone.lidars = {given};
    EXPECT_EQ(digest(back, nullptr), digest(lidar_alone, nullptr)) << format;
    EXPECT_EQ(imported_.info.origin_ns, 0);
    EXPECT_EQ(back.lidars[0].offset_ns, given.offset_ns);
    EXPECT_EQ(back.lidars[0].sweep_start_ns, given.sweep_start_ns);
  }
}

TEST_F(ImportSweeps, WithoutPointTimesTheyAreUnknownOrNotSkewed) {
  put("1.ply", sweep());
  put("2.ply", sweep());
  source_.steady_ns = 100000000;
  EXPECT_EQ(import().point_times, sim::PointTimes::unknown);
  source_.reading.not_skewed = true;
  const sim::LidarRecord lidar = import();
  EXPECT_EQ(lidar.point_times, sim::PointTimes::not_skewed);
  EXPECT_THAT(lidar.sweep_start_ns, ElementsAre(0, 100000000));
  EXPECT_THAT(lidar.offset_ns, ElementsAre(0, 0, 0, 0, 0, 0));
  write_recording(folder_ / "a.h5", imported_.info, imported_.sensors, nullptr);
  EXPECT_EQ(read_sensors(folder_ / "a.h5").lidars[0].point_times, sim::PointTimes::not_skewed);
  export_ply(imported_.sensors, folder_ / "again");
  EXPECT_THAT(test::read_file(folder_ / "again/lidar_000000.ply"), Not(HasSubstr("offset_ns")));
}

TEST_F(ImportSweeps, PointsFarBeyondTheSheetAreRefused) {
  put("1.ply", sweep());
  put("2.ply", sweep());
  source_.steady_ns = 100000000;
  source_.reading.range_max_m = 1.0;  // points 3.7 m away
  EXPECT_THAT(complaint_of(),
              HasSubstr("6 of 6 points are farther than 2 m, which is twice the range of the data sheet"));
  source_.reading.range_max_m = 2.0;
  EXPECT_EQ(import().position_L_m.size(), 6u);
}

TEST_F(ImportSweeps, PointsInMillimetresAreRefusedWithoutASheetToo) {
  source_.steady_ns = 100000000;
  std::string text = sweep();
  const auto replaced = [&](const std::string& was, const std::string& is) {
    for (std::size_t at = 0; (at = text.find(was, at)) != std::string::npos; at += is.size())
      text.replace(at, was.size(), is);
  };
  replaced("1 2 3\n", "1000 2000 3000\n");
  put("1.ply", text);
  put("2.ply", text);
  EXPECT_THAT(complaint_of(),
              HasSubstr("6 of 6 points are farther than 1000 m, which is twice the range of any robot lidar"));
  replaced("1000 2000 3000\n", "100 200 300\n");  // far, and no more
  put("1.ply", text);
  put("2.ply", text);
  EXPECT_EQ(complaint_of(), "");
}

TEST_F(ImportSweeps, AViewpointIsReported) {
  const std::string pcd = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n";
  put("1.pcd", pcd + "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
  put("2.pcd", pcd + "VIEWPOINT 5 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
  source_.format = "pcd";
  source_.steady_ns = 100000000;
  import();
  EXPECT_THAT(imported_.notes,
              Contains(AllOf(HasSubstr("1 sweeps have a VIEWPOINT"), HasSubstr("2.pcd: 5 0 0 1 0 0 0"))));
}

TEST_F(ImportSweeps, FilesStandInNaturalOrder) {
  for (const char* name : {"scan_10.ply", "scan_9.ply", "scan_011.ply"}) put(name, sweep());
  std::vector<std::string> names;
  for (const auto& file : sweep_files(folder_, ".ply", "")) names.push_back(file.filename().string());
  EXPECT_THAT(names, ElementsAre("scan_9.ply", "scan_10.ply", "scan_011.ply"));
}

TEST_F(ImportSweeps, StampsComeFromNamesOfSeveralKinds) {
  const std::vector<std::vector<const char*>> kinds = {{"1617333602.223639727.ply", "1617333602.323639727.ply"},
                                                       {"c_1617333602_223639727.ply", "c_1617333602_323639727.ply"},
                                                       {"1617333602223639727.ply", "1617333602323639727.ply"}};
  for (const auto& kind : kinds) {
    for (const char* name : kind) put(name, sweep());
    EXPECT_THAT(import().sweep_start_ns, ElementsAre(0, 100000000)) << kind[0];
    EXPECT_EQ(imported_.info.origin_ns, 1617333602223639727) << kind[0];
    EXPECT_EQ(imported_.sensors.lidars[0].sweep_period_ns, 100000000);
    for (const char* name : kind) fs::remove(folder_ / name);
  }
}

TEST_F(ImportSweeps, PointTimesAreReadInEveryDialect) {
  struct Case {
    const char* column;
    std::vector<std::string> first, second;  // sweeps at 50.0 s and 50.1 s
    const char* unit;
  };
  // the points were measured after 10, 20 and 90 ms
  const std::vector<Case> cases = {
      {"float time", {"0.01", "0.02", "0.09"}, {"0.01", "0.02", "0.09"}, ""},
      {"uint t", {"10000000", "20000000", "90000000"}, {"10000000", "20000000", "90000000"}, ""},
      {"float offset_time", {"10", "20", "90"}, {"10", "20", "90"}, ""},
      {"double timestamp", {"50.01", "50.02", "50.09"}, {"50.11", "50.12", "50.19"}, ""},
      {"double Timestamp", {"50.01", "50.02", "50.09"}, {"50.11", "50.12", "50.19"}, "s"},
      {"float t_us", {"10000", "20000", "90000"}, {"10000", "20000", "90000"}, ""}};
  source_.times = folder_ / "stamps";
  put("stamps", "50.0\n50.1\n");
  for (const Case& each : cases) {
    put("1.ply", sweep(each.column, each.first));
    put("2.ply", sweep(each.column, each.second));
    source_.reading.time_unit = each.unit;
    const sim::LidarRecord lidar = import();
    EXPECT_EQ(lidar.point_times, sim::PointTimes::measured) << each.column;
    EXPECT_THAT(lidar.sweep_start_ns, ElementsAre(0, 100000000)) << each.column;
    ASSERT_EQ(lidar.offset_ns.size(), 6u);
    // float32 seconds represent 90 ms to 4 ns
    for (const auto& [i, ns] : {std::pair{0, 1e7}, {1, 2e7}, {2, 9e7}, {5, 9e7}})
      EXPECT_NEAR(lidar.offset_ns[static_cast<std::size_t>(i)], ns, 4.0) << each.column;
  }
}

TEST_F(ImportSweeps, SweepsStampedAtTheirEndBeginAtTheirFirstPoint) {
  put("1.ply", sweep("float time", {"-0.1", "-0.05", "0"}));
  put("2.ply", sweep("float time", {"-0.1", "-0.05", "0"}));
  put("times.txt", "50.1\n50.2\n");
  const sim::LidarRecord lidar = import();
  EXPECT_NEAR(static_cast<double>(imported_.info.origin_ns), 50e9, 4.0);
  EXPECT_NEAR(lidar.offset_ns[1], 5e7, 4.0);
  EXPECT_EQ(lidar.offset_ns[0], 0u);
}

TEST_F(ImportSweeps, AbsoluteTimesOfPointsDetermineTheSweeps) {
  put("1.ply", sweep("double timestamp", {"1617333602.25", "1617333602.27", "1617333602.34"}));
  put("2.ply", sweep("double timestamp", {"1617333602.35", "1617333602.37", "1617333602.44"}));
  const sim::LidarRecord lidar = import();
  EXPECT_NEAR(static_cast<double>(imported_.info.origin_ns - 1617333602250000000), 0.0, 500.0);
  ASSERT_EQ(lidar.sweep_start_ns.size(), 2u);
  // a double of this size has a resolution of 0.24 us
  EXPECT_NEAR(static_cast<double>(lidar.sweep_start_ns[1]), 1e8, 500.0);
  EXPECT_NEAR(lidar.offset_ns[2], 9e7, 500.0);
}

TEST_F(ImportSweeps, MissesAreLeftOutAndIntensityIsScaled) {
  put("1.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "intensity\nproperty ushort ring\nproperty float nx\nend_header\n1 2 2 51 3 0\nnan nan nan 9 1 0\n0 0 0 9 1 0\n"
      "4 0 3 255 15 0\n");
  put("2.ply", sweep());
  source_.steady_ns = 100000000;
  const sim::LidarRecord lidar = import();
  EXPECT_THAT(lidar.sweep_first, ElementsAre(0u, 2u, 5u));
  EXPECT_THAT(lidar.range_m, ElementsAre(3.0f, 5.0f, testing::_, testing::_, testing::_));
  EXPECT_THAT(lidar.intensity, ElementsAre(0.2f, 1.0f, 0.0f, 0.0f, 0.0f));
  EXPECT_THAT(lidar.ring, ElementsAre(3, 15, 0, 0, 0));
  EXPECT_THAT(imported_.notes, Contains(HasSubstr("2 points are treated as missing returns")));
  EXPECT_THAT(imported_.notes, Contains(HasSubstr("3 points have no valid intensity")));
  EXPECT_THAT(imported_.notes, Contains("ignored fields: normal_x"));
}

TEST_F(ImportSweeps, HostileInputIsOneClearLine) {
  EXPECT_THAT(complaint_of(), HasSubstr("contains no file that ends in .ply"));
  put("1.ply", sweep());
  put("2.ply", sweep());
  EXPECT_THAT(complaint_of(), HasSubstr("1.ply: neither the sweep nor its points have a time stamp; state the times"));
  put("times.txt", "1.0\n");
  EXPECT_THAT(complaint_of(), HasSubstr("times.txt: the file contains 1 time stamps, but there are 2 sweeps"));
  put("times.txt", "# s\n1.1\n1.0\n");
  EXPECT_THAT(complaint_of(), HasSubstr("times.txt:3: the time stamp 1000000000 ns must be larger than the "
                                        "previous time stamp, 1100000000 ns"));
  put("times.txt", "1.0\n1.1x\n");
  EXPECT_THAT(complaint_of(), HasSubstr("times.txt:2: the time stamp '1.1x' must be in seconds"));
  put("times.txt", "1.0\n1.1\n");
  ASSERT_EQ(complaint_of(), "");
  put("2.ply", sweep("float time", {"0.01", "nan", "0.09"}));
  put("1.ply", sweep("float time", {"0.01", "0.05", "0.09"}));
  EXPECT_THAT(complaint_of(), HasSubstr("2.ply: the time of point 1 is nan"));
  put("2.ply", sweep("float time", {"0.01", "0.05", "0.5"}));
  source_.reading.time_unit = "s";
  EXPECT_THAT(complaint_of(),
              HasSubstr("2.ply: the time of point 2 is 449999999 ns after the middle of the sweep; it must be within"));
  put("2.ply", sweep());
  EXPECT_THAT(complaint_of(),
              HasSubstr("2.ply: the points have no field 'time' for their times, but other sweeps have this field"));
  put("2.ply", sweep("float ring", {"1", "2.5", "3"}));
  put("1.ply", sweep());
  EXPECT_THAT(complaint_of(), HasSubstr("2.ply: the ring of point 1 is 2.5"));
  put("2.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n");
  EXPECT_THAT(complaint_of(), HasSubstr("2.ply: the points have no field 'z' (existing fields: x y)"));
  put("2.ply", sweep("float x", {"nan", "nan", "nan"}));
  put("rear_1.ply", sweep());
  EXPECT_THAT(complaint_of(), HasSubstr("files of several lidars, '' and 'rear'"));
}

// the times are of no use, so no unit of them is asked for
TEST_F(ImportSweeps, EqualPointTimesMeanSweepsThatAreNotSkewed) {
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("float time", {"0", "0", "0"}));
  for (const bool stamped : {true, false}) {
    if (stamped) put("times.txt", "1.0\n1.1\n");
    if (!stamped) fs::remove(folder_ / "times.txt"), source_.steady_ns = 100000000;
    EXPECT_EQ(import().point_times, sim::PointTimes::not_skewed) << stamped;
    EXPECT_THAT(imported_.notes, Contains(HasSubstr("all points of a sweep have the same time")));
  }
}

TEST_F(ImportSweeps, AnAmbiguousUnitIsRequested) {
  put("times.txt", "1.0\n1.1\n");
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("float time", {"0.00001", "0.00002", "0.00005"}));
  EXPECT_THAT(complaint_of(), HasSubstr("1.ply: the point times in field 'time' have a range of"));
  EXPECT_THAT(complaint_of(), HasSubstr("0.15 to 150 % of the sweep period (100 ms). State the unit (--time-unit)"));
  source_.reading.time_unit = "s";
  EXPECT_EQ(complaint_of(), "");
  source_.reading.time_unit = "minutes";
  EXPECT_THAT(complaint_of(), HasSubstr("the unit of point times is 'minutes'; it must be s, ms, us or ns"));
  source_.reading = {};
  source_.reading.time_field = "tiem";
  EXPECT_THAT(complaint_of(), HasSubstr("no field 'tiem' (did you mean 'time'?)"));
}

// some drivers count times from each packet of a sweep, such as `time_stamp` in ns
TEST_F(ImportSweeps, TimesOverAPartOfASweepAreReadWithACaution) {
  std::vector<std::string> ns;
  for (int k = 0; k < 120; ++k) ns.push_back(std::to_string(11'000 * k));
  put("times.txt", "1.0\n1.1\n");
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("uint time_stamp", ns));
  EXPECT_EQ(import().point_times, sim::PointTimes::measured);
  EXPECT_THAT(imported_.notes,
              Contains("the point times come from field 'time_stamp', which counts ns from the sweep's time stamp"));
  EXPECT_THAT(imported_.notes, Contains(HasSubstr("caution: the point times span less than 2 %")));
}

TEST_F(ImportSweeps, UnknownFieldsAreNamedWithTheOption) {
  put("times.txt", "1.0\n1.1\n");
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("float firing", {"0.01", "0.05", "0.09"}));
  import();
  EXPECT_THAT(imported_.notes, Contains("the points have no time stamps, so sweeps cannot be deskewed (set "
                                        "'--time-field' to a field with times): firing"));
}

TEST_F(ImportSweeps, AUnitThatTheNumbersContradictIsRefusedWithBoth) {
  put("times.txt", "1.0\n1.1\n");
  std::vector<std::string> us;
  for (int k = 0; k < 120; ++k) us.push_back(std::to_string(10000 + 500 * k));
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("float time", us));
  import();
  EXPECT_THAT(imported_.notes,
              Contains("the point times come from field 'time', which counts us from the sweep's time stamp"));
  source_.reading.time_unit = "ns";
  EXPECT_THAT(
      complaint_of(),
      HasSubstr("1.ply: the point times in field 'time' have the stated unit ns and a range of 59500 in a sweep: in ns "
                "this is 0.0595 % of the sweep period, in us this is 59.5 % of the sweep period"));
  // the field's name states the unit too
  source_.reading.time_unit = "";
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("float t_ms", us));
  EXPECT_THAT(complaint_of(),
              HasSubstr("the point times in field 't_ms' have the stated unit ms and a range of 59500"));
  // a few points may be close together in any unit
  us.resize(90);
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("float t_ns", us));
  EXPECT_EQ(complaint_of(), "");
}

TEST_F(ImportSweeps, NoPointAtAllIsRefused) {
  for (const char* name : {"1.ply", "2.ply"}) put(name, sweep("", {}));
  source_.steady_ns = 100000000;
  EXPECT_THAT(complaint_of(), HasSubstr("all sweeps are empty; at least one sweep must have points"));
}

TEST_F(ImportSweeps, AnImuInTheSameClockJoinsAndInAnotherDoesNot) {
  sim::Recording recording = fixture::recording();
  for (Vector3d& force : recording.sensors.imus[1].accel_m_s2) force *= 0.2;  // scaled to a plausible median
  recording.sensors.imus[1].stated_gyro_range_rad_s = 80.0;                   // also scales the rates
  export_csv(recording.sensors, nullptr, folder_);
  export_ply(recording.sensors, folder_ / "sweeps");
  source_.folder = folder_ / "sweeps";
  const sim::ImuRecord& given = recording.sensors.imus[1];
  Imported both = import_sweeps(source_);
  attach_imus(both, import_imu_csv(folder_ / "imu_reference.csv", given));
  ASSERT_EQ(both.sensors.imus.size(), 1u);
  EXPECT_EQ(both.sensors.imus[0].time_ns, given.time_ns);
  EXPECT_EQ(both.sensors.imus[0].accel_m_s2, given.accel_m_s2);
  EXPECT_EQ(both.sensors.lidars[0].sweep_start_ns, recording.sensors.lidars[0].sweep_start_ns);
  Imported elsewhere = import_imu_csv(folder_ / "imu_reference.csv", given);
  elsewhere.info.origin_ns += 3600000000000;
  EXPECT_THAT(test::complaint([&] { attach_imus(both, std::move(elsewhere)); }),
              HasSubstr("check that both use the same clock"));
}

}  // namespace
}  // namespace tumble::scenarios
