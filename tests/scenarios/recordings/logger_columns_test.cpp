// SPDX-License-Identifier: BSD-3-Clause
// The test checks IMU tables as loggers and data sets write them: the names, units and times differ, and the readings
// are the same.
#include <fmt/format.h>

#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"

namespace tumble::scenarios {
namespace {

class LoggerTable : public test::TemporaryFolder {
 protected:
  Imported import(const std::string& text, AccelUnit unit = AccelUnit::m_s2, GyroUnit gyro_unit = GyroUnit::rad_s) {
    fixture::put(folder_ / "log.csv", text);
    return import_imu_csv(folder_ / "log.csv", {}, unit, gyro_unit);
  }
  Imported import_columns(const std::string& text, const std::string& columns) {
    fixture::put(folder_ / "log.csv", text);
    return import_imu_csv(folder_ / "log.csv", {}, AccelUnit::m_s2, GyroUnit::rad_s, columns);
  }
  std::string complaint_of(const std::string& text, AccelUnit unit = AccelUnit::m_s2) {
    return test::complaint([&] { import(text, unit); });
  }
};

/// Returns three samples 5 ms apart; `row` follows the time.
std::string table(const std::string& header, const std::vector<std::string>& times, const std::string& row) {
  std::string text = header + "\n";
  for (const std::string& time : times) text += time + row + "\n";
  return text;
}

void expect_the_readings(const Imported& imported) {
  const sim::ImuRecord& imu = imported.sensors.imus.at(0);
  ASSERT_THAT(imu.time_ns, ElementsAre(0, 5'000'000, 10'000'000));
  EXPECT_EQ(imu.period_ns, 5'000'000);
  EXPECT_TRUE(imu.gyro_rad_s[1].isApprox(Vector3d(0.1, 0.2, 0.3), 1e-12));
  EXPECT_TRUE(imu.accel_m_s2[1].isApprox(Vector3d(-0.5, 0.0, 9.8), 1e-12));
}

const std::vector<std::string> kSeconds = {"12.5", "12.505", "12.51"};
const std::string kRow = ",0.1,0.2,0.3,-0.5,0,9.8";

TEST_F(LoggerTable, NamesOfManyKindsAreKnown) {
  for (const char* header :
       {"t,gx,gy,gz,ax,ay,az", "time,gyro_x,gyro_y,gyro_z,acc_x,acc_y,acc_z",
        "Timestamp,GyroX,GyroY,GyroZ,AccelX,AccelY,AccelZ", "ts,wx,wy,wz,ax,ay,az",
        "\"time\",\"gyr.x\",\"gyr.y\",\"gyr.z\",\"acc.x\",\"acc.y\",\"acc.z\"",
        "time_s,angular_velocity_x,angular_velocity_y,angular_velocity_z,linear_acceleration_x,"
        "linear_acceleration_y,linear_acceleration_z",
        "stamp,imu gyro x,imu gyro y,imu gyro z,imu accel x,imu accel y,imu accel z",
        "time [s],gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2"}) {
    SCOPED_TRACE(header);
    expect_the_readings(import(table(header, kSeconds, kRow)));
  }
}

// the columns have the layout of EuRoC's and TUM VI's imu0/data.csv
TEST_F(LoggerTable, ColumnsOfEurocAreKnown) {
  const std::string header =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
      "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";
  const Imported imported =
      import(table(header, {"1403636579758555392", "1403636579763555392", "1403636579768555392"}, kRow));
  expect_the_readings(imported);
  EXPECT_EQ(imported.info.origin_ns, 1403636579758555392);
}

TEST_F(LoggerTable, SemicolonsTabulatorsAndOtherColumnsAreRead) {
  const auto separated = [](char by) {
    std::string text =
        table("mag_x,time_ms,gz,gy,gx,ax,ay,az,temp", {"7,100", "7,105", "7,110"}, ",0.3,0.2,0.1,-0.5,0,9.8,25");
    std::replace(text.begin(), text.end(), ',', by);
    return text;
  };
  for (const char by : {',', ';', '\t'}) {
    const Imported imported = import(separated(by));
    expect_the_readings(imported);
    EXPECT_THAT(imported.notes, Contains("ignored columns: mag_x, temp"));
    EXPECT_THAT(imported.notes, Not(Contains(HasSubstr("this unit gives a plausible time step"))));
  }
}

TEST_F(LoggerTable, TheUnitOfTimesIsTakenFromTheirSteps) {
  const auto notes_of = [&](const std::vector<std::string>& times) {
    const Imported imported = import(table("time,gx,gy,gz,ax,ay,az", times, kRow));
    expect_the_readings(imported);
    return imported.notes;
  };
  EXPECT_THAT(notes_of(kSeconds),
              Contains("the import reads time stamps in s, because this unit gives a plausible time step"));
  EXPECT_THAT(notes_of({"1700000000000", "1700000000005", "1700000000010"}),
              Contains(HasSubstr("the import reads time stamps in ms,")));
  EXPECT_THAT(notes_of({"0", "5000", "10000"}), Contains(HasSubstr("the import reads time stamps in us,")));
  EXPECT_THAT(notes_of({"1700000000000000000", "1700000000005000000", "1700000000010000000"}),
              Contains(HasSubstr("the import reads time stamps in ns,")));
  // Python prints sums of steps in this form
  EXPECT_THAT(notes_of({"0.005", "0.010000000000000002", "0.014999999999999999"}),
              Contains(HasSubstr("the import reads time stamps in s,")));
  // the step may be half a second or half a millisecond
  EXPECT_THAT(complaint_of(table("time,gx,gy,gz,ax,ay,az", {"0", "0.5", "1"}, kRow)),
              AllOf(HasSubstr("log.csv: the time step is 0.5"), HasSubstr("Add the unit to the column name")));
  // control: with a unit in the name the same table is read
  EXPECT_EQ(complaint_of(table("time_s,gx,gy,gz,ax,ay,az", {"0", "0.5", "1"}, kRow)), "");
}

// a logger that loses its power cuts the last line, and a full buffer cuts others
TEST_F(LoggerTable, OneCutLineCostsOneReading) {
  std::string whole = "time,gx,gy,gz,ax,ay,az\n";
  for (int k = 0; k < 50; ++k) whole += std::to_string(12.5 + 0.005 * k) + kRow + "\n";
  const auto one_lost = [&](const std::string& text, std::size_t kept) {
    SCOPED_TRACE(text.substr(text.size() - 40));
    const Imported imported = import(text);
    EXPECT_EQ(imported.sensors.imus.at(0).time_ns.size(), kept);
    EXPECT_THAT(imported.notes, Contains(HasSubstr("caution: the import leaves out 1 of 50 readings")));
  };
  one_lost(whole.substr(0, whole.size() - 5), 49);
  one_lost(whole.substr(0, whole.size() - 1), 49);
  std::string cut = whole;
  cut.erase(cut.find("12.6000") + 20, 9);
  one_lost(cut, 49);
  std::string spaced = whole;
  spaced.insert(spaced.find("12.6000"), "\n  \n");
  EXPECT_EQ(import(spaced).sensors.imus.at(0).time_ns.size(), 50u) << "empty lines are no samples";
}

TEST_F(LoggerTable, TimesMayBeDates) {
  const std::string row = table("time,gx,gy,gz,ax,ay,az",
                                {"2024-05-01T12:00:00.5Z", "2024-05-01 12:00:00.505", "2024-05-01T12:00:00.510"}, kRow);
  expect_the_readings(import(row));
  EXPECT_EQ(import(row).info.origin_ns, 1'714'564'800'500'000'000);
  expect_the_readings(import_columns(row, "time=time,gyro=gx,gy,gz,accel=ax,ay,az"));
}

// SampleTimeFine counts units of 0.1 ms; read in ms, the recording would last ten times as long
TEST_F(LoggerTable, XsensCountsTenthsOfMilliseconds) {
  const std::string text = "// DeviceId: 1\n" + table("SampleTimeFine,Gyr_X,Gyr_Y,Gyr_Z,Acc_X,Acc_Y,Acc_Z",
                                                      {"125000", "125050", "125100"}, kRow);
  expect_the_readings(import(text));
  expect_the_readings(import_columns(text, "time=SampleTimeFine,gyro=Gyr_X,Gyr_Y,Gyr_Z,accel=Acc_X,Acc_Y,Acc_Z"));
}

TEST_F(LoggerTable, StatedUnitsAreUsed) {
  const Imported imported = import(
      table("t,gx (deg/s),gy (deg/s),gz (deg/s),ax [g],ay [g],az [g]", kSeconds, ",57.29577951308232,0,0,0,0,1"));
  EXPECT_NEAR(imported.sensors.imus[0].gyro_rad_s[0].x(), 1.0, 1e-12);
  EXPECT_NEAR(imported.sensors.imus[0].accel_m_s2[0].z(), 9.80665, 1e-12);
  EXPECT_THAT(imported.notes, AllOf(Contains(HasSubstr("in deg/s")), Contains(HasSubstr("in g"))));
  EXPECT_EQ(complaint_of(table(
                "t,gx (\xC2\xB0/s),gy (\xC2\xB0/s),gz (\xC2\xB0/s),ax (m/s\xC2\xB2),ay (m/s\xC2\xB2),az (m/s\xC2\xB2)",
                kSeconds, kRow)),
            "");
  EXPECT_THAT(complaint_of(table("t,gx,gy,gz,ax [m/s^2],ay [m/s^2],az [m/s^2]", kSeconds, kRow), AccelUnit::g),
              HasSubstr("log.csv:1: the column names state"));
  EXPECT_THAT(complaint_of(table("t,gx,gy,gz,ax [m/s^2],ay [m/s^2],az [g]", kSeconds, kRow)),
              HasSubstr("the axes of the accel have different units"));
  EXPECT_THAT(complaint_of(table("t,gx,gy,gz,ax [N],ay [N],az [N]", kSeconds, kRow)),
              HasSubstr("log.csv:1: the unit in the name of column 'ax [N]' is unknown"));
}

// decimal commas in a table separated by commas: the first lines reveal that before their times do
TEST_F(LoggerTable, LinesOfAnotherWidthAreSaidBeforeTheirTimes) {
  EXPECT_THAT(complaint_of(table("time,gyro_x,gyro_y,gyro_z,acc_x,acc_y,acc_z", {"12,5", "12,505", "12,51"},
                                 ",0,1,0,2,0,3,-0,5,0,0,9,8")),
              HasSubstr("csv:2: this line has 14 columns, but the first line has 7; the numbers must be equal"));
}

TEST_F(LoggerTable, WhatIsMissingOrThereTwiceIsSaid) {
  EXPECT_THAT(complaint_of(table("t,gx,gy,gz,ax,ay,temp", kSeconds, kRow)),
              HasSubstr("log.csv:1: the table lacks these columns: accel_z"));
  EXPECT_THAT(complaint_of(table("n,gx,gy,gz,ax,ay,az", kSeconds, kRow)), HasSubstr("lacks these columns: time"));
  EXPECT_THAT(complaint_of(table("t,gx,gy,gz,ax,ay,az,acc_x", kSeconds, kRow + ",1")),
              HasSubstr("two columns contain the accel's axis x: 'ax' and 'acc_x'"));
  EXPECT_THAT(complaint_of(table("t,time,gx,gy,gz,ax,ay,az", {"1,1", "2,2"}, kRow)),
              HasSubstr("two columns contain time stamps, 't' and 'time'"));
  EXPECT_THAT(complaint_of(table("t,a,b", kSeconds, ",1,2")), HasSubstr("contains no known column name"));
}

TEST_F(LoggerTable, TimesThatAreNoneHaveTheirPlace) {
  for (const char* time : {"", "x", "1e", "e3", ".", "--1", "99999999999999999999", "1e300", "1.2.3"}) {
    EXPECT_THAT(complaint_of(table("time_s,gx,gy,gz,ax,ay,az", {"0", time}, kRow)),
                AllOf(HasSubstr("log.csv:3: column 0"), HasSubstr("must contain a time")))
        << time;
  }
  EXPECT_THAT(complaint_of(table("time_s,gx,gy,gz,ax,ay,az", {"0", "0.1", "0.05"}, kRow)),
              HasSubstr("log.csv:4: the time stamp (first time stamp + "));
}

/// The test uses the same three samples, with other lines around them and other fields in them.
TEST_F(LoggerTable, DialectsOfLoggersAreRead) {
  const std::string names = "time,gx,gy,gz,ax,ay,az";
  const std::vector<std::pair<const char*, std::string>> tables = {
      {"comments", "# recorded 2024-05-01\n# sensor, range 2000\n" + table(names, kSeconds, kRow) + "# end\n"},
      {"header in a comment", table("# " + names, kSeconds, kRow)},
      {"open ends", table(names, kSeconds, kRow + ",")},
      {"open ends and header", table(names + ",", kSeconds, kRow + ",")},
      {"row of units", table(names + "\ns,rad/s,rad/s,rad/s,m/s^2,m/s^2,m/s^2", kSeconds, kRow)},
      {"negative times", table(names, {"-0.995", "-0.99", "-0.985"}, kRow)},
      {"PX4 sensor_combined",
       table("timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],accelerometer_timestamp_relative,accelerometer_m_s2[0],"
             "accelerometer_m_s2[1],accelerometer_m_s2[2]",
             {"5000", "10000", "15000"}, ",0.1,0.2,0.3,0,-0.5,0,9.8")},
      {"ArduPilot", table("TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,T", {"5000", "10000", "15000"},
                          ",0,0.1,0.2,0.3,-0.5,0,9.8,0,40")},
      {"Sensor Logger",
       table("time,seconds_elapsed,gyroscope_x,gyroscope_y,gyroscope_z,accelerometer_x,accelerometer_y,accelerometer_z",
             {"1700000000005000000", "1700000000010000000", "1700000000015000000"}, ",0.1" + kRow)},
      {"phyphox",
       table("\"Time (s)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\",\"Gyroscope z (rad/s)\","
             "\"Acceleration x (m/s^2)\",\"Acceleration y (m/s^2)\",\"Acceleration z (m/s^2)\"",
             {"5.000000000E-3", "1.000000000E-2", "1.500000000E-2"}, ",1.0E-1,2.0E-1,3.0E-1,-5.0E-1,0.0,9.8E0")},
      {"one numbered IMU",
       table("time,imu1_gyro_x,imu1_gyro_y,imu1_gyro_z,accel1_x,accel1_y,accel1_z", kSeconds, kRow)}};
  for (const auto& [name, text] : tables) {
    SCOPED_TRACE(name);
    expect_the_readings(import(text));
  }
}

TEST_F(LoggerTable, NumbersMayBeInAnyNotation) {
  const auto text = [](char by) {
    std::string out =
        "time,gx,gy,gz,ax,ay,az\n5.000000000000000104e-03,+1e-1,2E-1,+0.3,-5.0e-01,0,9.8\n"
        "+1.000000000000000021e-02, 0.1 ,0.2,.3,-.5,0.,9.8\n1.499999999999999944e-02,0.1,0.2,0.3,-0.5,0,9.8e0\n";
    std::replace(out.begin(), out.end(), ',', by);
    return out;
  };
  for (const char by : {',', ' ', '\t'}) expect_the_readings(import(text(by)));
  expect_the_readings(import_columns(text(' ').substr(std::string("time,gx,gy,gz,ax,ay,az\n").size()),
                                     "time=0,gyro=1,2,3,accel=4,5,6"));
}

TEST_F(LoggerTable, AFurtherImuWithoutAKnownPositionIsLeftOut) {
  std::string text = "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ\n";
  for (const char* time : {"5000", "10000", "15000"})
    for (const char* id : {"0", "1"})
      text += std::string(time) + "," + id + (*id == '0' ? kRow : ",1,1,1,0,0,9.8") + "\n";
  const Imported imported = import(text);
  expect_the_readings(imported);
  EXPECT_EQ(imported.sensors.imus.size(), 1u);
  EXPECT_THAT(imported.notes, Contains(HasSubstr("IMU 1 is left out: only 0 samples have a rate above 2.5 rad/s")));
  // a row counter is no number of an IMU
  std::string counted = "id,time,gx,gy,gz,ax,ay,az\n";
  for (int k = 0; k < 12; ++k) counted += std::to_string(k) + "," + std::to_string(0.005 * k) + kRow + "\n";
  EXPECT_EQ(import(counted).sensors.imus[0].time_ns.size(), 12u);
}

/// Returns a table of two IMUs on one body that turns about changing axes. The second IMU is at `arm` from the first
/// one, its rates are multiplied by `scale`, and the times start at `from_s`.
std::string two_imus(const Vector3d& arm, double scale, double from_s) {
  std::string text = "time,id,gx,gy,gz,ax,ay,az\n";
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.01 * k;
    const Vector3d w(6.0 * std::sin(0.7 * t), 5.0 * std::cos(1.1 * t), 4.0 * std::sin(1.3 * t + 0.4));
    const Vector3d a(4.2 * std::cos(0.7 * t), -5.5 * std::sin(1.1 * t), 5.2 * std::cos(1.3 * t + 0.4));
    const Vector3d first(9.0 * std::cos(0.2 * t), 9.0 * std::sin(0.2 * t), 3.0);
    const Vector3d second = first + a.cross(arm) + w.cross(w.cross(arm)) + Vector3d(0.1, -0.2, 0.05);
    for (const auto& [id, rate, force] : {std::tuple{"A", w, first}, std::tuple{"B", Vector3d(scale * w), second}})
      text += fmt::format("{:.6f},{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}\n", from_s + t, id, rate.x(), rate.y(),
                          rate.z(), force.x(), force.y(), force.z());
  }
  return text;
}

TEST_F(LoggerTable, AFurtherImuIsPlacedByTheRotation) {
  const Vector3d arm(0.03, -0.02, 0.05);
  const Imported imported = import(two_imus(arm, 1.0, 2.0));
  ASSERT_EQ(imported.sensors.imus.size(), 2u);
  EXPECT_EQ(imported.sensors.imus[0].time_ns, imported.sensors.imus[1].time_ns);
  // the central difference of the rate has an error of 1e-4 rad/s^2
  EXPECT_LT((imported.sensors.imus[1].T_BI.translation() - imported.sensors.imus[0].T_BI.translation() - arm).norm(),
            1e-4);
  EXPECT_THAT(imported.notes,
              Contains(HasSubstr("the estimated position of IMU B is 0.03 -0.02 0.05 m relative to IMU A")));
  // negative control: a gyro that disagrees belongs to other axes
  const Imported other = import(two_imus(arm, -1.0, 2.0));
  EXPECT_EQ(other.sensors.imus.size(), 1u);
  EXPECT_THAT(other.notes, Contains(HasSubstr("IMU B is left out: the rates of both gyros differ by 200 % (median)")));
}

// loggers of rockets count the time from lift-off
TEST_F(LoggerTable, TimesMayBeNegative) {
  const Imported imported = import(two_imus({0.03, -0.02, 0.05}, 1.0, -0.35));
  EXPECT_EQ(imported.info.origin_ns, -350'000'000);
  EXPECT_EQ(imported.sensors.imus[0].time_ns.front(), 0);
  EXPECT_EQ(imported.sensors.imus[0].time_ns.back(), 9'990'000'000);
  EXPECT_THAT(imported.notes, Not(Contains(HasSubstr("wrong time stamp"))));
}

TEST_F(LoggerTable, TheUserNamesColumns) {
  const std::string two = table(
      "time,gyro1_x,gyro1_y,gyro1_z,accel1_x,accel1_y,accel1_z,gyro2_x,gyro2_y,gyro2_z,accel2_x,accel2_y,accel2_z",
      kSeconds, ",1,1,1,0,0,9.8" + kRow);
  EXPECT_THAT(complaint_of(two), AllOf(HasSubstr("log.csv:1: the gyro columns belong to several IMUs, '1' and '2'"),
                                       HasSubstr("--columns time=NAME")));
  expect_the_readings(import_columns(two, "time=time,gyro=gyro2_x,gyro2_y,gyro2_z,accel=accel2_x,accel2_y,accel2_z"));
  // units in the names count, also the unit of the time
  const Imported other = import_columns(table("n,stamp_us,rate a (deg/s),rate b (deg/s),rate c (deg/s),f,g,h",
                                              {"7,5000", "8,10000", "9,15000"}, ",57.29577951308232,0,0,-0.5,0,9.8"),
                                        "accel=f,g,h,time=stamp_us,gyro=rate a (deg/s),rate b (deg/s),rate c (deg/s)");
  EXPECT_THAT(other.sensors.imus[0].time_ns, ElementsAre(0, 5'000'000, 10'000'000));
  EXPECT_NEAR(other.sensors.imus[0].gyro_rad_s[0].x(), 1.0, 1e-12);
  const std::string split = table("a,b,c,d,e,f,g,h", {"12,500000000", "12,505000000", "12,510000000"}, kRow);
  const Imported seconds = import_columns(split, "time=a,b,gyro=c,d,e,accel=f,g,h");
  expect_the_readings(seconds);
  EXPECT_EQ(seconds.info.origin_ns, 12'500'000'000);
  const auto refused = [&](const char* choice) { return test::complaint([&] { import_columns(split, choice); }); };
  EXPECT_THAT(refused("time=a,b,gyro=c,d,e,accel=f,g,z"),
              HasSubstr("log.csv:1: --columns names 'z', but 0 of the 8 columns have this name"));
  EXPECT_THAT(refused("time=a,b,gyro=c,d,accel=f,g,h"), HasSubstr("--columns: gyro has 2 columns; it must have 3"));
  EXPECT_THAT(refused("gyro=c,d,e,accel=f,g,h"), HasSubstr("--columns: time has 0 columns"));
  EXPECT_THAT(refused("a,b"), HasSubstr("the entry 'a' of --columns must begin with time=, gyro= or accel="));
}

// tables that bagpy and `rostopic echo -p` make from a bag have the record's time first
TEST_F(LoggerTable, FlattenedMessagesHaveTheStampsOfTheirHeaders) {
  const Imported bagpy = import(table(
      "Time,header.seq,header.stamp.secs,header.stamp.nsecs,header.frame_id,angular_velocity.x,angular_velocity.y,"
      "angular_velocity.z,angular_velocity_covariance_0,linear_acceleration.x,linear_acceleration.y,"
      "linear_acceleration.z",
      {"50.1,0,12,500000000", "50.11,1,12,505000000", "50.2,2,12,510000000"}, ",imu,0.1,0.2,0.3,0,-0.5,0,9.8"));
  expect_the_readings(bagpy);
  EXPECT_EQ(bagpy.info.origin_ns, 12'500'000'000);
  const Imported echo =
      import(table("%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angular_velocity.x,"
                   "field.angular_velocity.y,field.angular_velocity.z,field.linear_acceleration.x,"
                   "field.linear_acceleration.y,field.linear_acceleration.z",
                   {"1700000000100000000,0,1700000000000000000", "1700000000110000000,1,1700000000005000000",
                    "1700000000200000000,2,1700000000010000000"},
                   ",imu" + kRow));
  expect_the_readings(echo);
  EXPECT_EQ(echo.info.origin_ns, 1'700'000'000'000'000'000);
}

}  // namespace
}  // namespace tumble::scenarios
