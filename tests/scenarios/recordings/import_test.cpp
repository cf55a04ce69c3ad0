// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/import.hpp"

#include <sys/stat.h>

#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tumble::scenarios {
namespace {

const std::string kHeader = "s,ns,frame,qx,qy,qz,qw,qc,wx,wy,wz,wc,ax,ay,az,ac\n";

std::string line(const std::string& stamp, const std::string& wx = "0.25") {
  return stamp + ",imu,0,0,0,1,[-1 0 0 0 0 0 0 0 0]," + wx +
         ",-1e-3,3,[0 0 0 0 0 0 0 0 0],9.5,0,-0.5,[0 0 0 0 0 0 0 0 0]\n";
}

class ImportCsv : public test::TemporaryFolder {
 protected:
  Imported import(const std::string& text) {
    fixture::put(folder_ / "run_1_xsens.csv", text);
    sim::ImuRecord device;
    device.name = "imu";
    device.device = "mti30";
    device.stated_gyro_range_rad_s = 80.0;  // the fixture has random rates of up to 44 rad/s
    device.time_ns = {1, 2, 3};             // times of another recording
    return import_imu_csv(folder_ / "run_1_xsens.csv", device);
  }
  std::string complaint_of(const std::string& text) {
    return test::complaint([&] { import(text); });
  }
};

TEST_F(ImportCsv, ReadsTheColumnsOfTheLayout) {
  const Imported imported =
      import(kHeader + line("1632000000,990000000") + line("1632000001,0") + line("1632000001,10000000"));
  ASSERT_EQ(imported.sensors.imus.size(), 1u);
  const sim::ImuRecord& imu = imported.sensors.imus[0];
  EXPECT_EQ(imu.device, "mti30");
  EXPECT_EQ(imu.stated_gyro_range_rad_s, 80.0);
  EXPECT_THAT(imu.time_ns, ElementsAre(0, 10000000, 20000000));
  EXPECT_EQ(imu.period_ns, 10000000);
  EXPECT_EQ(imu.gyro_rad_s[1], Vector3d(0.25, -1e-3, 3.0));
  EXPECT_EQ(imu.accel_m_s2[2], Vector3d(9.5, 0.0, -0.5));
  EXPECT_THAT(imu.clip_flags, ElementsAre(0, 0, 0));
  EXPECT_THAT(imported.info.attribution, HasSubstr("run_1_xsens.csv (first time stamp: 1632000000990000000 ns)"));
  write_recording(folder_ / "a.h5", imported.info, imported.sensors, nullptr);
  EXPECT_EQ(read_sensors(folder_ / "a.h5").imus[0].time_ns, imu.time_ns);
}

TEST_F(ImportCsv, TakesBackWhatExportWrote) {
  sim::Recording recording = fixture::recording();
  for (Vector3d& force : recording.sensors.imus[1].accel_m_s2) force *= 0.2;  // scaled to a plausible median
  recording.sensors.imus[1].stated_gyro_range_rad_s = 80.0;                   // also the fixture's rates
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

/// Returns a table of a body that rocks about y, read every `step_ms`, with stamps of whole milliseconds.
std::string rocking(double step_ms) {
  std::ostringstream text;
  text.precision(12);
  text << "sec,nsec,wx,wy,wz,ax,ay,az\n";
  for (int k = 0; k < 3000; ++k) {
    const double time_s = 1e-3 * step_ms * k, angle = 0.5 * std::sin(2.0 * time_s);
    const auto stamp_ms = static_cast<std::int64_t>(std::llround(1e3 * time_s));
    text << stamp_ms / 1000 << ',' << stamp_ms % 1000 * 1'000'000 << ",0," << std::cos(2.0 * time_s) << ",0,"
         << -9.81 * std::sin(angle) << ",0," << 9.81 * std::cos(angle) << '\n';
  }
  return text.str();
}

TEST_F(ImportCsv, PutsStampsInWholeMillisecondsOnTheBeatOfAFasterImuAndSaysSo) {
  for (const double step_ms : {1.2, 1.5, 1.9, 2.4}) {
    const Imported imported = import(rocking(step_ms));
    const std::vector<std::int64_t>& stamps = imported.sensors.imus[0].time_ns;
    double worst_ns = 0.0;
    for (std::size_t k = 0; k < stamps.size(); ++k)
      worst_ns = std::max(worst_ns, std::abs(static_cast<double>(stamps[k]) - 1e6 * step_ms * static_cast<double>(k)));
    EXPECT_LT(worst_ns, 1.5e5) << step_ms;  // the original time stamps had errors of up to 0.5 ms
    EXPECT_NEAR(static_cast<double>(imported.sensors.imus[0].period_ns), 1e6 * step_ms, 1e3);
    EXPECT_THAT(imported.notes, Contains(HasSubstr("whole milliseconds"))) << step_ms;
  }
  for (const double step_ms : {1.0, 2.0, 4.0}) {  // a period of whole milliseconds is exact
    const Imported imported = import(rocking(step_ms));
    EXPECT_THAT(imported.notes, Not(Contains(HasSubstr("whole milliseconds"))));
    EXPECT_EQ(imported.sensors.imus[0].time_ns[1], static_cast<std::int64_t>(1e6 * step_ms));
  }
}

const std::string kNamed =
    "__time,/imu/angular_velocity/x,/imu/angular_velocity/y,/imu/angular_velocity/z,/imu/header/seq,/imu/header/stamp,"
    "/imu/linear_acceleration/x,/imu/linear_acceleration/y,/imu/linear_acceleration/z\n";

TEST_F(ImportCsv, FindsColumnsByNameAndReadsStampsToTheNanosecond) {
  fixture::put(folder_ / "a.csv", kNamed + "1.5,0.1,0.2,0.3,7,1617333602.223639727,-0.5,0,1\n" +
                                      "1.6,0.1,0.2,0.4,8,1617333602.2316,-0.5,0,1\n");
  const Imported imported = import_imu_csv(folder_ / "a.csv", {}, AccelUnit::g);
  const sim::ImuRecord& imu = imported.sensors.imus.at(0);
  EXPECT_THAT(imu.time_ns, ElementsAre(0, 231600000 - 223639727));
  EXPECT_EQ(imu.gyro_rad_s[1], Vector3d(0.1, 0.2, 0.4));
  EXPECT_EQ(imu.accel_m_s2[0], 9.80665 * Vector3d(-0.5, 0.0, 1.0));
  EXPECT_THAT(imported.info.attribution, HasSubstr("first time stamp: 1617333602223639727 ns"));
}

TEST_F(ImportCsv, AnotherUnitOrAMissingColumnIsSaid) {
  const std::string rows =
      "1.5,0.1,0.2,0.3,7,1617333602.223639727,-0.5,0,1\n1.6,0.1,0.2,0.4,8,1617333602.24,-0.5,0,1\n";
  EXPECT_THAT(complaint_of(kNamed + rows),
              HasSubstr("median specific force is 1.118034 m/s^2 if the accelerometer is read in m/s^2"));
  std::string without = kNamed;
  without.replace(without.find("velocity/y"), 10, "velocity_y");
  EXPECT_THAT(complaint_of(without + rows), HasSubstr("csv:1: missing columns: angular_velocity/y"));
  std::string twice = kNamed;
  twice.replace(twice.find("__time"), 6, "/b/header/stamp");
  EXPECT_THAT(complaint_of(twice + rows), HasSubstr("csv:1: two columns have the name header/stamp"));
  for (const char* stamp : {"", "x", "1.5e", "12345678901.5"})
    EXPECT_THAT(complaint_of(kNamed + "1.5,0.1,0.2,0.3,7," + stamp + ",-0.5,0,9\n"),
                HasSubstr("csv:2: column 5 must contain a time"));
}

TEST_F(ImportCsv, ReadsTheLogOfASphere) {
  for (const test::DataFolder& folder : test::data_folders("sphere_log")) {
    SCOPED_TRACE(folder.path);
    const auto log = test::written(folder) / test::kSphereLogFile;
    const sim::ImuRecord imu = import_imu_csv(log, {}, AccelUnit::g).sensors.imus.at(0);
    ASSERT_EQ(imu.time_ns.size(), folder.real ? 7294u : test::kStandInSphereSamples);
    EXPECT_NEAR(static_cast<double>(imu.period_ns), 8e6, 1e5) << "125 Hz";
    EXPECT_NEAR(static_cast<double>(imu.time_ns.back()) * 1e-9, folder.real ? 58.34 : 30.0, 0.01);
    EXPECT_NEAR(imu.accel_m_s2[0].norm(), 9.81, 0.1) << "at rest at the start";
  }
}

/// Returns the lines of a file with their columns in another order.
std::string reordered(const std::string& text, const std::vector<std::size_t>& order) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    for (std::size_t i = 0; i < order.size(); ++i) out += (i > 0 ? "," : "") + fields.at(order[i]);
    out += "\n";
  }
  return out;
}

class ImportOwnCsv : public ImportCsv {
 protected:
  ImportOwnCsv() {
    sim::Recording recording = fixture::recording();
    for (Vector3d& force : recording.sensors.imus[1].accel_m_s2) force *= 0.2;  // scaled to a plausible median
    export_csv(recording.sensors, nullptr, folder_);
    given_ = recording.sensors.imus[1];
    text_ = test::read_file(folder_ / "imu_reference.csv");
  }
  sim::ImuRecord given_;
  std::string text_;
  const std::vector<std::size_t> order_ = {14, 0, 10, 3, 4, 9, 5, 6, 7, 13, 8, 2, 11, 12, 1, 15};
};

TEST_F(ImportOwnCsv, NamesCountBeforePositions) {
  const Imported imported = import(reordered(text_, order_));
  EXPECT_EQ(imported.sensors.imus[0].gyro_rad_s, given_.gyro_rad_s);
  EXPECT_EQ(imported.sensors.imus[0].accel_m_s2, given_.accel_m_s2);
  EXPECT_EQ(imported.sensors.imus[0].period_ns, given_.period_ns);
  // control: the same columns without their names are read by position, which is wrong here
  std::string moved = reordered(text_, order_);
  moved.erase(0, moved.find('\n') + 1);
  EXPECT_NE(complaint_of(moved), "");
}

TEST_F(ImportOwnCsv, DoubledUnknownAndMissingColumnsAreRefused) {
  const auto renamed = [&](const std::string& from, const std::string& to) {
    std::string other = text_;
    return other.replace(other.find(from), from.size(), to);
  };
  EXPECT_EQ(complaint_of(text_), "");
  EXPECT_THAT(complaint_of(renamed("wy_rad_s", "wx_rad_s")), HasSubstr("csv:1: two columns have the name wx_rad_s"));
  EXPECT_THAT(complaint_of(renamed("wy_rad_s", "wy_deg_s")), HasSubstr("csv:1: unknown column 'wy_deg_s'"));
  EXPECT_THAT(complaint_of(renamed("wy_rad_s", "wy_rads")), HasSubstr("did you mean 'wy_rad_s'"));
  EXPECT_THAT(complaint_of(reordered(text_, {0, 1, 2, 3, 8, 9, 10, 12, 13})),
              HasSubstr("csv:1: missing columns: fz_m_s2"));
  fixture::put(folder_ / "a.csv", text_);
  EXPECT_THAT(test::complaint([&] { import_imu_csv(folder_ / "a.csv", {}, AccelUnit::g); }),
              HasSubstr("the column names state rad/s and m/s^2"));
}

TEST_F(ImportOwnCsv, AFileWithoutHeaderKeepsItsFirstSample) {
  const Imported imported = import(text_.substr(text_.find('\n') + 1));
  EXPECT_EQ(imported.sensors.imus[0].gyro_rad_s, given_.gyro_rad_s);
  EXPECT_EQ(imported.sensors.imus[0].time_ns.size(), given_.time_ns.size());
}

TEST_F(ImportCsv, AGapDoesNotChangeThePeriod) {
  std::string text = kHeader;
  for (const char* stamp : {"1,0", "1,10000000", "1,20000000", "1,920000000", "1,930000000"}) text += line(stamp);
  EXPECT_EQ(import(text).sensors.imus[0].period_ns, 10000000);
  EXPECT_THAT(import(text).notes, Not(Contains(HasSubstr("gap"))));
  const Imported silent = import(text + line("5,0") + line("86405,0"));
  EXPECT_THAT(
      silent.notes,
      Contains(HasSubstr("2 gaps of more than 1 s without data; the longest gap lasts 8.64e+04 s before reading 6")));
}

TEST_F(ImportCsv, WindowsLineEndsAreRead) {
  std::string text = kHeader + line("1,0") + line("1,10000000");
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2))
    text.insert(at, 1, '\r');
  EXPECT_EQ(import(text).sensors.imus[0].time_ns.size(), 2u);
}

TEST_F(ImportCsv, BadInputHasFileAndLine) {
  const std::string good = kHeader + line("1,0") + line("1,10000000");
  EXPECT_EQ(complaint_of(good), "");
  EXPECT_THAT(complaint_of(""), HasSubstr("is empty"));
  EXPECT_THAT(complaint_of(kHeader), HasSubstr("has 0 IMU samples"));
  EXPECT_THAT(complaint_of(kHeader + line("1,0")), HasSubstr("has 1 IMU samples"));
  EXPECT_THAT(complaint_of(good + line("1,10000000")), HasSubstr("csv:4: the time stamp (first time stamp + "));
  EXPECT_THAT(complaint_of(good + line("1,5000000")), HasSubstr("csv:4: the time stamp (first time stamp + "));
  EXPECT_THAT(complaint_of(good + line("1,20000000", "nan")), HasSubstr("csv:4: column 8 is not finite"));
  EXPECT_THAT(complaint_of(good + line("1,20000000", "")),
              HasSubstr("csv:4: column 8 must contain a number, but contains ''"));
  EXPECT_THAT(complaint_of(good + line("1,20000000", "0.5x")),
              HasSubstr("csv:4: column 8 must contain a number, but contains '0.5x'"));
  EXPECT_THAT(complaint_of(good + line("1.5,0")), HasSubstr("csv:4: column 0 must contain a whole number"));
  EXPECT_THAT(complaint_of(good + line("1,1000000000")),
              HasSubstr("csv:4: column 1 must contain a whole number from 0 to 999999999, but contains '1000000000'"));
  EXPECT_THAT(complaint_of(good + line("1,20000000", "1e7")),
              HasSubstr("csv:4: an IMU reading has the magnitude 1e+07 rad/s or m/s^2; it must be at most 1e+06"));
  EXPECT_THAT(complaint_of(good + line("1e30,0")), HasSubstr("csv:4: column 0 must contain a whole number"));
  EXPECT_EQ(complaint_of(good + "\n \r\n"), "") << "nothing follows";
  EXPECT_EQ(complaint_of(good + "\n" + line("1,20000000")), "") << "an empty line is no sample";
  EXPECT_THAT(complaint_of(good + line("1,20000000").substr(0, 60) + "\n"), HasSubstr("csv:4: this line has"));
  EXPECT_THAT(complaint_of("a,b\n1,2\n"), HasSubstr("csv:1: the header contains no known column name"));
  EXPECT_THAT(complaint_of("1,2\n"), HasSubstr("csv:1: the file has 2 columns and no header; a file without header"));
  EXPECT_THAT(complaint_of(good.substr(0, good.size() - 1)), HasSubstr("csv:3: the last line has no line end"))
      << "a last number may be cut in its middle";
  EXPECT_THAT(test::complaint([&] { import_imu_csv(folder_ / "none.csv", {}); }), HasSubstr("none.csv: no such file"));
  EXPECT_THAT(test::complaint([&] { import_imu_csv(folder_, {}); }), HasSubstr("is a folder; it must be a file"));
}

TEST_F(ImportCsv, BytesThatAreNoLinesOfTextAreCalledSo) {
  const std::string good = kHeader + line("1,0") + line("1,10000000");
  std::string wide = "\xFF\xFE";
  for (const char c : good) wide += {c, '\0'};
  EXPECT_THAT(complaint_of(wide), HasSubstr("csv: the text of the file is in UTF-16; it must be in UTF-8"));
  std::string spoiled = good;
  spoiled[good.size() - 40] = '\0';
  EXPECT_THAT(complaint_of(spoiled), HasSubstr("csv:3: the file contains a zero byte"));
  std::string returns = good;
  std::replace(returns.begin(), returns.end(), '\n', '\r');
  EXPECT_THAT(complaint_of(returns),
              HasSubstr("csv: the lines of the file end in a carriage return; they must end in a"));
}

// opening a pipe for reading would wait for a writer
TEST_F(ImportCsv, APipeIsRefusedAndNotWaitedFor) {
  ASSERT_EQ(mkfifo((folder_ / "pipe.csv").c_str(), 0600), 0);
  EXPECT_THAT(test::complaint([&] { import_imu_csv(folder_ / "pipe.csv", {}); }),
              HasSubstr("pipe.csv: is a pipe; it must be a regular file"));
}

// The test checks rates and stamps in another unit than stated, which a rolling sphere's readings reveal.
/// Returns a table of a sphere that turns about y, so that gravity turns the other way in its axes; the stamps have
/// steps of `step_ns`.
std::string rolled(double rate_rad_s, double written_for_one, std::int64_t step_ns = 4'000'000) {
  std::ostringstream text;
  text << "sec,nsec,wx,wy,wz,fx,fy,fz\n";
  for (std::int64_t k = 0; k < 1000; ++k) {
    const double angle = rate_rad_s * 0.004 * static_cast<double>(k);
    text << k * step_ns / 1'000'000'000 << ',' << k * step_ns % 1'000'000'000 << ",0," << rate_rad_s * written_for_one
         << ",0," << -9.81 * std::sin(angle) << ",0," << 9.81 * std::cos(angle) << '\n';
  }
  return text.str();
}

class ImportSphere : public test::TemporaryFolder {
 protected:
  Imported import(const std::string& text, double range_rad_s, GyroUnit unit = GyroUnit::rad_s) {
    fixture::put(folder_ / "sphere.csv", text);
    sim::ImuRecord device;
    device.name = "imu";
    device.stated_gyro_range_rad_s = range_rad_s;
    return import_imu_csv(folder_ / "sphere.csv", device, AccelUnit::m_s2, unit);
  }
  std::string complaint_of(const std::string& text, double range_rad_s, GyroUnit unit = GyroUnit::rad_s) {
    return test::complaint([&] { import(text, range_rad_s, unit); });
  }
};

// within 0.2 s the sphere turns too far for the windows; a range of 150 rad/s admits 229
TEST_F(ImportSphere, RatesInDegreesAreMetByTheTurning) {
  constexpr double kDegrees = 57.29577951308232;
  const Imported good = import(rolled(4.0, 1.0), 150.0);
  EXPECT_EQ(gravity_rotation(good.sensors.imus[0], RotationWindows::even).windows, 0);
  EXPECT_THAT(good.notes, Contains(HasSubstr("gyro and accelerometer agree in units and axes")));
  EXPECT_THAT(complaint_of(rolled(4.0, kDegrees), 150.0), HasSubstr("The rates may be in deg/s"));
  EXPECT_EQ(complaint_of(rolled(4.0, kDegrees), 150.0, GyroUnit::deg_s), "");
  EXPECT_THAT(complaint_of(rolled(4.0, 1.0), 150.0, GyroUnit::deg_s), HasSubstr("The rates may be in rad/s"));
}

TEST_F(ImportSphere, RatesBeyondTheRangeAreAnotherUnit) {
  EXPECT_THAT(complaint_of(rolled(5.0, 57.3), 7.854),
              AllOf(HasSubstr("100 % of the rates exceed 15.7 rad/s"), HasSubstr("The rates may be in deg/s")));
  EXPECT_THAT(complaint_of(rolled(5.0, 57.3), 0.0), HasSubstr("exceed 100 rad/s (above any robot's rate)"));
  EXPECT_THAT(complaint_of(rolled(5.0, 7505.0), 7.854), HasSubstr("The rates may be in raw counts of the sensor"));
  EXPECT_EQ(complaint_of(rolled(5.0, 1.0), 7.854), "");
}

TEST_F(ImportSphere, ForcesWithoutGravityAreMet) {
  std::string text = "sec,nsec,wx,wy,wz,fx,fy,fz\n";
  for (int k = 0; k < 100; ++k) text += "0," + std::to_string(k * 10'000'000) + ",0,0,0,0.1,0,0.02\n";
  EXPECT_THAT(complaint_of(text, 7.854), HasSubstr("the readings may be linear acceleration, without gravity"));
  text = "sec,nsec,wx,wy,wz,fx,fy,fz\n";
  for (int k = 0; k < 300; ++k)
    text += "0," + std::to_string(k * 3'000'000) + ",0,0,0," + (k < 100 ? "0.1" : "1.4") + ",0,0.02\n";
  EXPECT_THAT(complaint_of(text, 7.854),
              AllOf(HasSubstr("the specific force is 0.102 at the start and 1.4 in the median"),
                    Not(HasSubstr("--accel-unit"))))
      << "a robot at rest would measure 1 in g";
}

TEST_F(ImportSphere, AGyroThatReadsNothingIsSaid) {
  EXPECT_THAT(import(rolled(2.5, 0.0), 7.854).notes, Contains(HasSubstr("reads 0 on all axes in all 1000")));
  EXPECT_THAT(import(rolled(2.5, 1.0), 7.854).notes, Not(Contains(HasSubstr("caution"))));
}

// gravity turns about another axis than the gyro reports
TEST_F(ImportSphere, WhatTurnsButNotAsTheGyroSaysIsNotCalledStill) {
  std::string text = rolled(2.5, 1.0);
  text.replace(0, text.find('\n'), "sec,nsec,wy,wx,wz,fx,fy,fz");
  EXPECT_THAT(import(text, 7.854).notes, Contains(HasSubstr("gyro and accelerometer measure different rotations")));
}

TEST_F(ImportSphere, StampsInAnotherUnitAreMet) {
  // the stamps are ms and us where seconds are expected, and us where nanoseconds are expected
  for (const std::int64_t step_ns : {4'000'000'000, 4'000'000'000'000})
    EXPECT_THAT(complaint_of(rolled(2.5, 1.0, step_ns), 7.854), HasSubstr("The time stamps may be in another unit"));
  EXPECT_THAT(complaint_of(rolled(2.5, 1.0, 4'000), 7.854),
              HasSubstr("the median time step is 4e-06 s; it must be from 2e-05 to 2 s."));
}

}  // namespace
}  // namespace tumble::scenarios
