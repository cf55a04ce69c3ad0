// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/trajectories/align_reference.hpp"
#include "scenarios/recordings/trajectories/reference_glitches.hpp"
#include "stand_ins/stand_ins.hpp"
#include "stand_ins/synthetic_repoimu.hpp"

namespace tumble::scenarios {
namespace {

using fixture::Wand;
using testing::HasSubstr;

std::string all_notes(const Imported& imported) {
  std::string text;
  for (const std::string& note : imported.notes) text += note + "\n";
  return text;
}

double median(std::vector<double> values) {
  EXPECT_FALSE(values.empty());
  if (values.empty()) return 1e9;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

class Repoimu : public fixture::Folder {
 protected:
  Imported import(const std::string& text, bool align = false) {
    fixture::put(folder_ / "wand.csv", text);
    return import_repoimu(folder_ / "wand.csv", align);
  }
  std::string complaint_of(const std::string& text) {
    return fixture::complaint([&] { import(text); });
  }
};

TEST_F(Repoimu, TakesTheFileAsItIs) {
  const Wand wand;
  const Imported imported = import(repoimu_text(wand));
  const sim::ImuRecord& imu = imported.sensors.imus.at(0);
  ASSERT_EQ(imu.time_ns.size(), 4000u);
  EXPECT_EQ(imu.period_ns, 10'000'000);
  EXPECT_EQ(imu.time_ns[3999], 39'990'000'000) << "stamps on a raster stay as they are";
  EXPECT_NEAR(imu.gyro_rad_s[100].y(), Wand::rate(1.0).y(), 1e-4);
  EXPECT_NEAR(imu.accel_m_s2[100].norm(), 9.80665, 1e-3);
  EXPECT_TRUE(imu.magnetic_field_t.empty());
  EXPECT_THAT(all_notes(imported), HasSubstr("units and axes agree"));
  EXPECT_THAT(all_notes(imported), HasSubstr("set --align-reference to remove it"));
  EXPECT_THAT(all_notes(imported), HasSubstr("the gyro of 'imu'")) << "the reference is compared with the gyro";
  EXPECT_THAT(all_notes(imported), testing::Not(HasSubstr("sample and hold")));
  EXPECT_THAT(all_notes(imported), testing::Not(HasSubstr("the accelerometer seems to be saturated")))
      << "gravity at rest is not saturated";
  // expected reference, as written in the file
  ASSERT_TRUE(imported.reference);
  const sim::Truth& truth = *imported.reference;
  EXPECT_EQ(truth.period_ns, 10'000'000);
  const fixture::WandAttitude attitude(wand.duration_s);
  const Eigen::Quaterniond q = wand.q_VW * attitude.at(2.0 - wand.delay_s) * wand.q_IV;
  EXPECT_LT(truth.q_WB[200].angularDistance(q), 1e-4);
  EXPECT_FALSE(truth.p_WB_m[200].allFinite()) << "no position is known";
  write_recording(folder_ / "a.h5", imported.info, imported.sensors, &truth);
  EXPECT_EQ(read_truth(folder_ / "a.h5").imus.at(0).rate_rad_s.size(), 4000u);
  EXPECT_TRUE(is_repoimu(folder_ / "wand.csv"));
}

TEST_F(Repoimu, DelayRotationAndTiltOfTheReferenceAreFoundAndTakenOut) {
  const Wand wand;
  fixture::put(folder_ / "wand.csv", repoimu_text(wand));
  const Imported raw = import_repoimu(folder_ / "wand.csv", false);
  std::vector<ReferencePose> poses;
  for (std::size_t k = 0; k < raw.reference->q_WB.size(); ++k) {
    poses.push_back(
        {static_cast<std::int64_t>(k) * raw.reference->period_ns, Eigen::Vector3d::Zero(), raw.reference->q_WB[k]});
  }
  const ReferenceAlignment alignment = align_reference(poses, raw.sensors.imus[0]);
  ASSERT_TRUE(alignment.known);
  EXPECT_NEAR(alignment.delay_s, wand.delay_s, 3.0 * alignment.delay_sigma_s + 3e-4);
  EXPECT_LT(alignment.delay_sigma_s, 2e-3);
  EXPECT_LT(alignment.q_IV.angularDistance(wand.q_IV), 0.004) << "turned by 0.07 rad";
  EXPECT_LT(alignment.q_IV_sigma_rad.maxCoeff(), 0.01);

  const Imported aligned = import_repoimu(folder_ / "wand.csv", true);
  const sim::Truth& truth = *aligned.reference;
  const fixture::WandAttitude attitude(wand.duration_s);
  std::vector<double> tilts, errors;
  for (std::size_t k = 1000; k + 1000 < truth.q_WB.size(); k += 50) {
    const double t = 1e-9 * static_cast<double>(static_cast<std::int64_t>(k) * truth.period_ns);
    const Eigen::Vector3d up = truth.q_WB[k].conjugate() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d up_true = attitude.at(t).conjugate() * Eigen::Vector3d::UnitZ();
    tilts.push_back(std::acos(std::min(1.0, up.dot(up_true))));
  }
  EXPECT_LT(median(tilts), 0.005) << "off by 0.05 and 0.07 rad before";
  const sim::ImuRecord& imu = aligned.sensors.imus[0];
  for (std::size_t k = 100; k + 100 < imu.time_ns.size(); ++k) {
    const Eigen::Vector3d w = Wand::rate(1e-9 * static_cast<double>(imu.time_ns[k]));
    if (std::abs(w.x()) > 8.0) errors.push_back((truth.imus[0].rate_rad_s[k] - w).norm());
  }
  ASSERT_GT(errors.size(), 100u) << "the wand is twirled beyond the rail";
  EXPECT_LT(median(errors), 0.1) << "rates of the truth at samples that clip";
}

// a slow sensor in a fast log repeats its readings; the accelerometer is slower than the gyro
TEST_F(Repoimu, SampleAndHoldIsRecognisedAndUndone) {
  Wand wand;
  wand.log_hz = 90.0, wand.gyro_hz = 50.0, wand.accel_hz = 25.0, wand.decimals = 3;
  const Imported imported = import(repoimu_text(wand));
  const sim::ImuRecord& imu = imported.sensors.imus.at(0);
  EXPECT_NEAR(static_cast<double>(imu.time_ns.size()), 2000.0, 3.0);
  EXPECT_THAT(all_notes(imported),
              HasSubstr("(sample and hold): 44.5 % of the gyro's rows and 72.2 % of the accelerometer's"));
  EXPECT_NEAR(static_cast<double>(imu.period_ns), 20e6, 0.5e6) << "get the sample times of the gyro";
  // the period equals the sensor's period, although readings appear up to one log step late
  double error = 0.0, held_error = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 20; k + 20 < imu.time_ns.size(); ++k) {
    const double t = 1e-9 * static_cast<double>(imu.time_ns[k]);
    error = std::max(error, (imu.gyro_rad_s[k] - fixture::clipped(wand, Wand::rate(t))).norm());
    ++count;
  }
  for (int k = 100; k < 3500; ++k) {
    const double t = k / wand.log_hz;
    held_error = std::max(held_error, (Wand::rate(fixture::held(t, 50.0)) - Wand::rate(t)).norm());
  }
  ASSERT_GT(count, 1000u);
  EXPECT_LT(error, 0.5 * held_error) << "negative control: the log as it is errs by " << held_error;
  EXPECT_THAT(all_notes(imported), HasSubstr("interpolated between its distinct readings"));
}

TEST_F(Repoimu, GlitchesOfTheReferenceAreLeftOutWithACount) {
  Wand wand;
  wand.flips_s = {3.0, 12.0, 25.5};
  std::string text = repoimu_text(wand);
  const Imported imported = import(text);
  EXPECT_THAT(all_notes(imported), HasSubstr("within or between 6 jumps of up to 3"));
  double fastest = 0.0;
  std::size_t unknown = 0;
  for (const Eigen::Vector3d& w : imported.reference->imus.at(0).rate_rad_s) {
    if (w.allFinite())
      fastest = std::max(fastest, w.norm());
    else
      ++unknown;
  }
  EXPECT_LT(fastest, 13.0) << "the motion's own peak is 11.8";
  EXPECT_GT(unknown, 3u * 15u);
  EXPECT_LT(unknown, 3u * 40u) << "and little beside them";
  // negative control: without flips, only the two ends of the recording are dropped
  wand.flips_s = {};
  const Imported clean = import(repoimu_text(wand));
  EXPECT_THAT(all_notes(clean), HasSubstr("reference: 0 of 4000 samples are left out"));
}

TEST(ReferenceGlitches, ATwirlIsNoLeap) {
  // the rate rises from rest to 16 rad/s within 50 ms and falls again, as in a hand
  std::vector<ReferencePose> poses;
  double angle = 0.0;
  for (int k = 0; k < 300; ++k) {
    const double rate = 16.0 * std::clamp(std::min((k - 100) / 5.0, (150 - k) / 5.0), 0.0, 1.0);
    angle += 0.01 * rate;
    poses.push_back({k * 10'000'000ll, Eigen::Vector3d::Zero(),
                     Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()))});
  }
  EXPECT_EQ(leave_out_glitches(poses).leaps, 0u);
  EXPECT_EQ(poses.size(), 300u);
  poses[200].q_WA = poses[200].q_WA * Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  EXPECT_GE(leave_out_glitches(poses).leaps, 1u) << "one attitude off by half a radian is";
}

TEST_F(Repoimu, WhatPublishedFilesHoldIsRead) {
  Wand wand;
  wand.duration_s = 10.0;
  const std::string text = repoimu_text(wand);
  // the file has other line ends, a decimal comma, an averaged attitude, and the headers of the pendulum files
  std::string windows;
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(import(windows).sensors.imus[0].time_ns.size(), 1000u);
  std::string comma = text;
  const std::size_t at = comma.find("1.2300;") + 7;  // w of the quaternion
  comma[comma.find('.', at)] = ',';
  EXPECT_THAT(all_notes(import(comma)), HasSubstr("1 numbers have a decimal comma"));
  std::string average = text;
  const std::size_t w = average.find("\n5.0000;") + 8;
  average.replace(w, average.find(';', w) - w, "0.2");
  EXPECT_THAT(all_notes(import(average)),
              HasSubstr("1 because the norm of the quaternion differs from 1 by more than 1 %"));
  std::string pendulum = text;
  pendulum.replace(0, std::string(fixture::kRepoimuHeader).size(),
                   "Time;Vicon Orientation;;;;IMU Acceleration;;;IMU Gyroscope;;;IMU Magnetometer;;\n"
                   "s;W;X;Y;Z;X;Y;Z;X;Y;Z;X;Y;Z\n");
  EXPECT_EQ(import(pendulum).sensors.imus[0].gyro_rad_s, import(text).sensors.imus[0].gyro_rad_s);
}

TEST_F(Repoimu, ASaturatedAccelerometerIsNoted) {
  Wand wand;
  wand.duration_s = 5.0;
  const std::string given = repoimu_text(wand);
  std::string text = fixture::kRepoimuHeader;
  std::istringstream lines(given.substr(text.size()));
  int row = 0;
  for (std::string line; std::getline(lines, line); ++row) {
    std::vector<std::string> f;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ';');) f.push_back(field);
    if (row % 50 < 20) f.at(5) = "19.6" + std::to_string(row % 10);
    for (std::size_t i = 0; i + 1 < f.size(); ++i) text += f[i] + ";";
    text += f.back() + "\n";
  }
  EXPECT_THAT(all_notes(import(text)), HasSubstr("the accelerometer seems to be saturated"));
}

// the reader finds columns by their names
TEST_F(Repoimu, ColumnsMayStandElsewhere) {
  Wand wand;
  wand.duration_s = 5.0;
  const std::string text = repoimu_text(wand);
  std::string moved = "Time (s);IMU Gyroscope;;;Vicon Orientation;;;;IMU Acceleration;;\n;X;Y;Z;W;X;Y;Z;X;Y;Z\n";
  std::istringstream lines(text.substr(std::string(fixture::kRepoimuHeader).size()));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> f;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ';');) f.push_back(field);
    for (const std::size_t i : {0, 8, 9, 10, 1, 2, 3, 4, 5, 6}) moved += f.at(i) + ";";
    moved += f.at(7) + "\n";
  }
  const Imported plain = import(text), other = import(moved);
  EXPECT_EQ(other.sensors.imus[0].gyro_rad_s, plain.sensors.imus[0].gyro_rad_s);
  EXPECT_EQ(other.sensors.imus[0].accel_m_s2, plain.sensors.imus[0].accel_m_s2);
  EXPECT_LT(other.reference->q_WB[50].angularDistance(plain.reference->q_WB[50]), 1e-12);
}

TEST_F(Repoimu, BadInputHasFileLineValueAndBound) {
  const std::string header = fixture::kRepoimuHeader;
  const auto row = [](const std::string& time, const std::string& w = "1", const std::string& gx = "0.1") {
    return time + ";" + w + ";0;0;0;0.1;0.2;9.8;" + gx + ";0;0;0.4;0.2;-0.9\n";
  };
  const std::string good = header + row("0.01") + row("0.02") + row("0.03");
  EXPECT_EQ(complaint_of(good), "");
  EXPECT_THAT(complaint_of(""), HasSubstr("is empty"));
  EXPECT_THAT(complaint_of(header), HasSubstr("has 0 samples"));
  EXPECT_THAT(complaint_of(good.substr(0, good.size() - 1)), HasSubstr("csv:5: the last line has no line end"));
  EXPECT_THAT(complaint_of(good + "0.04;1;0;0\n"), HasSubstr("csv:6: this line has 4 columns; it must have 14"));
  EXPECT_THAT(complaint_of(good + row("0.04", "1", "nan")), HasSubstr("csv:6: column IMU Gyroscope is not finite"));
  EXPECT_THAT(complaint_of(good + row("0.04", "1", "")),
              HasSubstr("csv:6: column IMU Gyroscope must be a number; it is ''"));
  EXPECT_THAT(complaint_of(good + row("0.04", "1", "1.000,5")), HasSubstr("must be a number; it is '1.000,5'"));
  EXPECT_THAT(complaint_of(good + row("0.02")), HasSubstr("csv:6: Time decreases: 0.02 s follows 0.03 s"));
  EXPECT_THAT(complaint_of(good + row("0.0405") + row("0.0405")), HasSubstr("Time must increase"));
  EXPECT_THAT(complaint_of(good + row("-1")), HasSubstr("csv:6: Time is -1 s; it must be within 0 and"));
  EXPECT_THAT(complaint_of(header + row("0.01", "0.7") + row("0.02", "0.7")),
              HasSubstr("csv:3: the quaternion's norm is 0.7000; it must be 1 within 1 %. This error affects 2 of 2"));
  std::string missing = good;
  missing.replace(missing.find("IMU Gyroscope"), 13, "IMU Compasses");
  EXPECT_THAT(complaint_of(missing), HasSubstr("csv:2: missing columns: 'IMU Gyroscope/X' 'IMU Gyroscope/Y'"));
  std::string doubled = good;
  doubled.replace(doubled.find(";W;X;Y;Z;"), 9, ";W;X;Y;Y;");
  EXPECT_THAT(complaint_of(doubled), HasSubstr("two columns have the name Vicon Orientation/Y"));
  std::string unknown = good;
  unknown.replace(unknown.find(";X;Y;Z;\n"), 8, ";X;Y;Z;T\n");
  EXPECT_THAT(complaint_of(unknown), HasSubstr("unknown column"));
  EXPECT_THAT(fixture::complaint([&] { import_repoimu(folder_ / "none.csv", false); }), HasSubstr("no such file"));
}

TEST_F(Repoimu, RatesInDegreesAreNoticedByGravity) {
  Wand wand;
  std::string text = fixture::kRepoimuHeader;
  const std::string given = repoimu_text(wand);
  std::istringstream lines(given.substr(text.size()));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> f;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ';');) f.push_back(field);
    for (const std::size_t i : {8, 9, 10}) f.at(i) = std::to_string(57.29578 * std::stod(f.at(i)));
    for (std::size_t i = 0; i < f.size(); ++i) text += (i > 0 ? ";" : "") + f[i];
    text += "\n";
  }
  EXPECT_THAT(complaint_of(text), HasSubstr("The rates may be in deg/s"));
}

TEST_F(Repoimu, ReadsTheStandIn) {
  const Imported wand = import_repoimu(test::written(test::data_folders("repoimu").front()) / test::kStandInWand, true);
  EXPECT_EQ(wand.sensors.imus[0].time_ns.size(), 12000u);
  EXPECT_THAT(all_notes(wand), HasSubstr("units and axes agree"));
  EXPECT_THAT(all_notes(wand), HasSubstr("jumps of up to"));
  // while the gyro is unsaturated, the reference's rate must equal the gyro's rate
  std::vector<double> errors;
  const sim::ImuRecord& imu = wand.sensors.imus[0];
  const std::vector<Eigen::Vector3d>& rates = wand.reference->imus.at(0).rate_rad_s;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (rates[k].allFinite() && std::abs(imu.gyro_rad_s[k].x()) < 6.0)
      errors.push_back((rates[k] - imu.gyro_rad_s[k]).norm());
  }
  EXPECT_GT(errors.size(), 10000u);
  EXPECT_LT(median(errors), 0.02);
}

/// RepoimuPublished tests the published files, which are not part of the project. The tests exist only if the files are
/// available.
class RepoimuPublished : public ::testing::TestWithParam<std::filesystem::path> {};

INSTANTIATE_TEST_SUITE_P(Files, RepoimuPublished, ::testing::ValuesIn(test::published_folders("repoimu")));
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RepoimuPublished);

TEST_P(RepoimuPublished, AreRead) {
  const std::filesystem::path folder = GetParam();
  const Imported wand = import_repoimu(folder / "TStick_Test05_Trial1.csv", true);
  EXPECT_EQ(wand.sensors.imus[0].time_ns.size(), 8813u);
  EXPECT_THAT(all_notes(wand), HasSubstr("units and axes agree"));
  const Imported pendulum = import_repoimu(folder / "Pendulum_Test02a_Trial1_Segment_3.csv", true);
  EXPECT_NEAR(static_cast<double>(pendulum.sensors.imus[0].time_ns.size()), 8681.0, 5.0) << "of 15630 rows";
  EXPECT_THAT(all_notes(pendulum),
              HasSubstr("(sample and hold): 44.5 % of the gyro's rows and 71.8 % of the accelerometer's"));
  EXPECT_THAT(all_notes(pendulum), HasSubstr("+x within 2 % of 19.52 m/s^2")) << "2 g";
  EXPECT_THAT(all_notes(pendulum), HasSubstr("jumps of up to"));
  EXPECT_THAT(all_notes(pendulum), HasSubstr("1 numbers have a decimal comma"));
  for (const Eigen::Vector3d& w : pendulum.reference->imus.at(0).rate_rad_s) {
    if (w.allFinite()) {
      ASSERT_LT(w.norm(), 25.0) << "no leap is left";
    }
  }
}

}  // namespace
}  // namespace tumble::scenarios
