// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/recording_check.hpp"

#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

TEST(RecordingCheck, AcceptsASoundRecording) {
  const sim::Recording recording = fixture::recording();
  EXPECT_EQ(find_problem(recording.sensors), "");
  EXPECT_EQ(find_problem(recording.truth), "");
  EXPECT_EQ(find_mismatch(recording.sensors, recording.truth), "");
  EXPECT_EQ(find_problem(sim::Sensors{}), "");
  EXPECT_EQ(find_problem(sim::Truth{}), "");
}

TEST(RecordingCheck, LeavesReadingsToTheEstimator) {
  sim::Sensors sensors = fixture::recording().sensors;
  sensors.imus[0].gyro_rad_s[3].setConstant(std::nan(""));
  sensors.imus[0].time_ns[3] = sensors.imus[0].time_ns[2];
  EXPECT_EQ(find_problem(sensors), "");
}

TEST(RecordingCheck, NamesWhatContradicts) {
  struct Case {
    std::function<void(sim::Sensors&)> spoil;
    const char* problem;
  };
  const double nan = std::nan("");
  const std::vector<Case> cases = {
      {[](auto& s) { s.imus[1].gyro_rad_s.pop_back(); },
       "sensors/imus/1: gyro_I_rad_s has 69 rows, but time_ns has 70; the numbers must be equal"},
      {[](auto& s) { s.imus[1].accel_m_s2.clear(); }, "accel_I_m_s2 has 0 rows"},
      {[](auto& s) { s.imus[1].clip_flags.push_back(0); }, "clip_flags has 71 rows"},
      {[](auto& s) { s.imus[1].magnetic_field_t.pop_back(); },
       "magnetic_field_I_t has 69 rows; it must have 70 or none"},
      {[nan](auto& s) { s.imus[0].earth_field_W_t.x() = nan; }, "sensors/imus/0: earth_field_W_t is not finite"},
      {[](auto& s) { s.imus[0].period_ns = 0; }, "sensors/imus/0: period_ns is 0"},
      {[](auto& s) { s.imus[0].time_ns[0] = std::numeric_limits<std::int64_t>::min(); },
       "sensors/imus/0: time_ns is -9223372036854775808 in row 0; it must be within 1e17 ns"},
      {[](auto& s) { s.imus[1].time_ns.back() = 1700000000000000000; }, "time_ns is 1700000000000000000 in row 69"},
      {[](auto& s) { s.imus[0].name = "a\xff\xfe"; },
       "sensors/imus/0: name must be UTF-8 text without control characters"},
      {[](auto& s) { s.imus[0].device = "\x1b[31m"; }, "device must be UTF-8 text without control characters"},
      {[](auto& s) { s.lidars[0].name = "\xc3"; }, "name must be UTF-8 text without control characters"},
      {[](auto& s) { s.lidars[0].sweep_start_ns[0] = std::numeric_limits<std::int64_t>::min(); },
       "sweep_start_ns is -9"},
      {[nan](auto& s) { s.imus[0].stated_gyro_range_rad_s = nan; }, "stated_gyro_range_rad_s is nan"},
      {[](auto& s) { s.imus[0].T_BI.linear() *= 1.001; }, "T_BI must be a rigid transform"},
      {[](auto& s) { s.imus[0].T_BI.linear() *= -1.0; }, "T_BI must be a rigid transform"},
      {[nan](auto& s) { s.imus[0].T_BI.translation().x() = nan; }, "T_BI is not finite"},
      {[nan](auto& s) { s.gravity_m_s2 = nan; }, "gravity_m_s2 is nan"},
      {[](auto& s) { s.sphere_radius_m = -1; }, "sphere_radius_m"},
      {[](auto& s) { s.lidars[0].sweep_period_ns = -1; }, "sweep_period_ns is -1"},
      {[](auto& s) { s.lidars[0].ring.pop_back(); }, "ring has 149 rows"},
      {[](auto& s) { s.lidars[0].sweep_first.pop_back(); }, "one more than sweep_start_ns (3)"},
      {[](auto& s) {
         s.lidars[0].sweep_first = {0, 100, 50, 150};
       },
       "sweep_first decreases"},
      {[](auto& s) { s.lidars[0].sweep_first.back() = 149; }, "must increase from 0 to the number of points, 150"},
      {[](auto& s) { s.lidars[0].sweep_first.front() = 1; }, "must increase from 0"},
      {[](auto& s) { s.lidars[0].point_times = sim::PointTimes::unknown; },
       "offset_ns is 3125 at point 1; it must be 0 if points have no time stamps"},
      {[](auto& s) { s.lidars[0].point_times = static_cast<sim::PointTimes>(3); }, "point_times must be measured"},
      {[](auto& s) { s.lidars[0].sweep_start_ns[1] = 0; }, "sweep_start_ns does not increase"},
      {[](auto& s) { s.series[0].time_ns.pop_back(); },
       "sensors/series/0: quantities/0: values has 5 rows, but time_ns has 4; the numbers must be equal"},
      {[](auto& s) { s.series[0].quantities[1].values.pop_back(); }, "quantities/1: values has 4 rows"},
      {[nan](auto& s) { s.series[0].quantities[1].noise = nan; }, "quantities/1: noise is nan"},
      {[](auto& s) { s.series[0].quantities[1].name = "a,b"; },
       "quantities/1: the name of this entry must consist of letters, digits and _, and must not be empty"},
      {[](auto& s) { s.series[0].quantities[1].name = ""; },
       "the name of this entry must consist of letters, digits and _, and must not be empty"},
      {[](auto& s) { s.series[0].quantities[1].unit = "\x1b"; }, "unit must be UTF-8 text without control characters"},
      {[](auto& s) { s.series[0].quantities[1].name = "pressure_pa"; },
       "quantities/1: two entries of 'quantities' have the same name"},
      {[](auto& s) {
         s.series[0].constants.push_back({"ground_pressure_pa", 1.0});
       },
       "sensors/series/0: constants/1: two entries of 'constants' have the same name"},
      {[](auto& s) { s.series[0].constants[0].name = "a b"; },
       "constants/0: the name of this entry must consist of letters, digits and _, and must not be empty"},
      {[nan](auto& s) { s.series[0].constants[0].value = nan; },
       "constants/0: the value of this constant is not finite"},
      {[](auto& s) { s.series[0].kind = "\xff"; },
       "sensors/series/0: kind must be UTF-8 text without control characters"},
      {[](auto& s) { s.series[0].period_ns = 0; }, "sensors/series/0: period_ns is 0"},
      {[](auto& s) { s.series[0].T_BX.linear() *= -1.0; }, "T_BX must be a rigid transform"},
      {[](auto& s) { s.series[0].time_ns.back() = 1700000000000000000; }, "time_ns is 1700000000000000000 in row 4"}};
  for (const Case& each : cases) {
    sim::Sensors sensors = fixture::recording().sensors;
    each.spoil(sensors);
    EXPECT_THAT(find_problem(sensors), HasSubstr(each.problem));
  }
}

TEST(RecordingCheck, NamesWhatContradictsInTheTruth) {
  struct Case {
    std::function<void(sim::Truth&)> spoil;
    const char* problem;
  };
  const std::vector<Case> cases = {
      {[](auto& t) { t.q_WB.pop_back(); }, "truth: q_WB has 39 rows, but p_WB_m has 40; the numbers must be equal"},
      {[](auto& t) { t.label.pop_back(); }, "label has 39 rows; it must have 40 or none"},
      {[](auto& t) { t.f_B_m_s2.pop_back(); }, "f_B_m_s2 has 39 rows; it must have 40 or none"},
      {[](auto& t) { t.q_WB[3].w() = std::numeric_limits<double>::quiet_NaN(); },
       "the quaternion q_WB (attitude of the body in the world) must have norm 1"},
      {[](auto& t) { t.period_ns = 0; }, "truth: period_ns is 0"},
      {[](auto& t) { t.q_WB[3].coeffs() *= 1.01; },
       "the quaternion q_WB (attitude of the body in the world) must have norm 1"},
      {[](auto& t) { t.q_WB[3].coeffs().setZero(); },
       "the quaternion q_WB (attitude of the body in the world) must have norm 1"},
      {[](auto& t) { t.label[3] = static_cast<sim::ContactLabel>(4); }, "label 4 is unknown"},
      {[](auto& t) { t.contacts[3].time_ns = 0; }, "contacts/time_ns must not decrease"},
      {[](auto& t) { t.contacts[3].surface_id = 2; }, "surface_id 2 has no name"},
      {[](auto& t) { t.lidars[0].surface_id[3] = -3; }, "truth/lidars/0: surface_id -3"},
      {[](auto& t) { t.lidars[0].hit_W_m.pop_back(); }, "surface_id has 150 rows, but hit_W_m has 149"},
      {[](auto& t) { t.imus[1].magnetic_field_t.pop_back(); }, "truth/imus/1: magnetic_field_I_t has 69 rows"},
      {[](auto& t) { t.imus[1].gyro_elements.resize(2); }, "truth/imus/1: gyro_elements_I has 2 rows; it must have 3"},
      {[](auto& t) { t.imus[1].accel_elements.resize(4); },
       "truth/imus/1: accel_elements_I has 4 rows; it must have 3"},
      {[](auto& t) { t.imus[0].gyro_element_offset_rad_s.y() = std::nan(""); },
       "truth/imus/0: gyro_element_offset_rad_s is not finite"},
      {[](auto& t) { t.imus[0].accel_element_offset_m_s2.y() = std::nan(""); },
       "truth/imus/0: accel_element_offset_m_s2 is not finite"},
      {[](auto& t) { t.imus[1].gyro_bias_rad_s.clear(); }, "truth/imus/1: gyro_bias_I_rad_s has 0 rows"},
      {[](auto& t) { t.series[0].T_BX.linear() *= 1.001; }, "truth/series/0: T_BX must be a rigid transform"},
      {[](auto& t) { t.series[0].quantities[1].name = " "; },
       "truth/series/0: quantities/1: the name of this entry must consist of letters, digits and _, and must not be "
       "empty"},
      {[](auto& t) { t.p_BG_m.x() = std::numeric_limits<double>::infinity(); }, "p_BG_m is not finite"}};
  for (const Case& each : cases) {
    sim::Truth truth = fixture::recording().truth;
    each.spoil(truth);
    EXPECT_THAT(find_problem(truth), HasSubstr(each.problem));
  }
}

TEST(RecordingCheck, AReferenceMayKnowPosesAlone) {
  sim::Recording recording = fixture::recording();
  sim::Truth& truth = recording.truth;
  truth.f_B_m_s2.clear();
  truth.label.clear();
  truth.contacts.clear();
  truth.q_WB[3].coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  for (sim::ImuTruth& imu : truth.imus) {
    sim::ImuTruth poses;
    poses.name = imu.name;
    poses.T_BI = imu.T_BI;
    imu = poses;
  }
  for (sim::LidarTruth& lidar : truth.lidars) lidar = {lidar.name, lidar.T_BL, {}, {}};
  for (sim::SeriesTruth& series : truth.series) series.quantities.clear();
  EXPECT_EQ(find_problem(truth), "");
  EXPECT_EQ(find_mismatch(recording.sensors, truth), "");
}

TEST(RecordingCheck, TruthMustRunParallelToTheSensors) {
  sim::Recording recording = fixture::recording();
  recording.truth.imus.pop_back();
  EXPECT_THAT(find_mismatch(recording.sensors, recording.truth), HasSubstr("number of IMUs"));
  recording = fixture::recording();
  fixture::Numbers numbers;
  recording.truth.imus[1] = fixture::imu_truth(numbers, "imu_reference", 71);
  EXPECT_THAT(find_mismatch(recording.sensors, recording.truth), HasSubstr("imus/1: truth rate_I_rad_s has 71 rows"));
  recording = fixture::recording();
  recording.truth.series.pop_back();
  EXPECT_THAT(find_mismatch(recording.sensors, recording.truth), HasSubstr("number of series"));
  recording = fixture::recording();
  recording.truth.series[0].quantities.pop_back();
  EXPECT_THAT(find_mismatch(recording.sensors, recording.truth), HasSubstr("series/0: truth and sensor differ"));
  recording = fixture::recording();
  recording.truth.series[0].quantities[1].values.pop_back();
  EXPECT_THAT(find_mismatch(recording.sensors, recording.truth), HasSubstr("quantities/1: truth values has 4 rows"));
}

}  // namespace
}  // namespace tumble::scenarios
