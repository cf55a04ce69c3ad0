// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rig_calibration_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "scenarios/errors.hpp"
#include "tests/complaint.hpp"
#include "tests/temporary_folder.hpp"

namespace tumble::scenarios {
namespace {

class RigCalibrationFile : public testing::TemporaryFolder {
 protected:
  static CalibratedRig example() {
    CalibratedRig rig;
    rig.calibration.constants.lever_arm_m = {-0.0213, -0.0851, 1.0 / 3.0};
    rig.calibration.constants.gyro_bias_rad_s = {1e-3, -2e-17, 0.1};
    rig.calibration.constants.inertia << 0.1, -0.2, 0.3, 1e-9, 0.0;
    rig.calibration.constants.gyro_misalignment << 0.05, -0.01, 1e-3, 0.0, 0.02, -0.03;
    rig.calibration.covariance = 0.7e-4 * RigConstants::Matrix::Identity();
    rig.calibration.covariance(0, 4) = rig.calibration.covariance(4, 0) = 2e-7;
    rig.saturation_limits = {10.5, std::nullopt, 10.4, std::nullopt, std::nullopt, std::nullopt};
    rig.gyro_saturation_planes_rad_s[2] = {-10.25, 10.55};
    rig.accel_saturation_planes_m_s2[0] = {std::nullopt, 77.5};
    rig.accel_misalignment << 0.016, -0.0026, 0.0, 0.0, 0.0, 0.0;
    rig.known_sensor_errors = KnownSensorErrors{};
    rig.known_sensor_errors->errors.accel_delay_s = 0.0041;
    rig.known_sensor_errors->errors.g_sensitivity_s_m(2, 0) = -1.3e-4;
    rig.known_sensor_errors->covariance = 1e-6 * SensorErrors::Matrix::Identity();
    rig.known_sensor_errors->covariance(0, 27) = rig.known_sensor_errors->covariance(27, 0) = 3e-7;
    return rig;
  }

  std::filesystem::path path() const { return folder_ / "learnt.json"; }

  std::string text() const {
    std::stringstream stream;
    stream << std::ifstream(path()).rdbuf();
    return stream.str();
  }

  std::string complaint(const std::string& from, const std::string& to) const {
    write_rig_calibration(path(), example());
    std::string spoilt = text();
    const std::size_t at = spoilt.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) spoilt.replace(at, from.size(), to);
    std::ofstream(path()) << spoilt;
    return test::complaint([&] { read_rig_calibration(path()); });
  }
};

TEST_F(RigCalibrationFile, ComesBackTheSameToTheBit) {
  write_rig_calibration(path(), example());
  const CalibratedRig back = read_rig_calibration(path());
  EXPECT_TRUE(back.calibration.constants == example().calibration.constants);
  EXPECT_EQ(back.calibration.covariance, example().calibration.covariance);
  EXPECT_EQ(back.saturation_limits, example().saturation_limits);
  EXPECT_EQ(back.gyro_saturation_planes_rad_s, example().gyro_saturation_planes_rad_s);
  EXPECT_TRUE(back.saturation_planes() == example().saturation_planes());
  EXPECT_EQ(back.accel_saturation_planes_m_s2, example().accel_saturation_planes_m_s2);
  EXPECT_TRUE(back.saturation_planes(Triad::accelerometer) == example().saturation_planes(Triad::accelerometer));
  ASSERT_TRUE(back.saturation_planes(Triad::accelerometer).sensing_axis[0].has_value());
  EXPECT_EQ(back.saturation_planes(Triad::accelerometer).sensing_axis[0]->row, Eigen::Vector3d(1.0, 0.016, -0.0026));
  EXPECT_TRUE(back.saturation_planes(Triad::accelerometer).sensing_axis[0]->was_reached(1));
  EXPECT_FALSE(back.saturation_planes(Triad::accelerometer).sensing_axis[0]->was_reached(-1));
  ASSERT_TRUE(back.known_sensor_errors.has_value());
  EXPECT_TRUE(back.known_sensor_errors->errors == example().known_sensor_errors->errors);
  EXPECT_EQ(back.known_sensor_errors->covariance, example().known_sensor_errors->covariance);
  EXPECT_FALSE(back.saturation_planes().sensing_axis[0].has_value());
  ASSERT_TRUE(back.saturation_planes().sensing_axis[2].has_value());
  EXPECT_NEAR(back.saturation_planes().sensing_axis[2]->saturation_limit_rad_s, 10.4, 1e-12);
  EXPECT_NEAR(back.saturation_planes().sensing_axis[2]->offset_rad_s, 0.15, 1e-12);
}

TEST_F(RigCalibrationFile, ComplaintsNameTheKey) {
  EXPECT_NE(complaint("lever_arm_m", "lever_arm").find("lever_arm_m: missing"), std::string::npos);
  EXPECT_NE(complaint("\"inertia\"", "\"spare\": 1, \"inertia\"").find("spare: unknown key"), std::string::npos);
  EXPECT_NE(complaint("10.4", "-10.4").find("gyro_rail_rad_s"), std::string::npos);
  EXPECT_NE(complaint("10.4", "10.4, 3").find("needs exactly 3 numbers"), std::string::npos);
  EXPECT_NE(complaint("2e-07", "1.0").find("covariance"), std::string::npos);
  EXPECT_NE(complaint("{", "").find("not a JSON object"), std::string::npos);
  EXPECT_NE(complaint("-10.25", "10.25").find("gyro_planes_rad_s"), std::string::npos);
  EXPECT_NE(complaint("77.5", "-77.5").find("accelerometer_planes_m_s2"), std::string::npos);
  EXPECT_NE(complaint("\"accelerometer_elements\"", "\"gone\"").find("gone: unknown key"), std::string::npos);
  EXPECT_NE(complaint("3e-07", "1.0").find("device_errors_covariance"), std::string::npos);
  EXPECT_NE(complaint("\"device_errors\"", "\"gone\"").find("gone: unknown key"), std::string::npos);
  EXPECT_EQ(complaint("10.4", "10.3"), "");  // negative control: a valid change is accepted
}

// When two elements were saturated only together, nobody knows the level at which the plane cuts the row: the next run
// would assume a saturation level that does not exist.
TEST_F(RigCalibrationFile, PlanesWithAnUncertainLevelAreNotSaved) {
  SaturationPlane plane;
  plane.row = {1.0, 0.05, 0.0};
  plane.saturation_limit_rad_s = 10.2;
  plane.samples = {0, 11};
  plane.log_odds = 20.0;
  plane.covariance.diagonal() << 4e-6, 4e-6, 2e-6, 2e-6;
  SaturationPlanes planes;
  planes.sensing_axis[0] = plane;
  CalibratedRig told, untold;
  told.keep_prior_planes(planes);
  EXPECT_EQ(told.gyro_saturation_planes_rad_s[0][1].value_or(0.0), 10.2);
  EXPECT_FALSE(told.gyro_saturation_planes_rad_s[0][0].has_value());
  // a slope that is uncertain by 0.03, where the other axis read 10, leaves the level uncertain by 0.3
  planes.sensing_axis[0]->covariance(1, 1) = 9e-4;
  planes.sensing_axis[0]->covariance(1, 2) = planes.sensing_axis[0]->covariance(2, 1) = 9e-3;
  planes.sensing_axis[0]->covariance(2, 2) = 9e-2;
  untold.keep_prior_planes(planes);
  EXPECT_FALSE(untold.gyro_saturation_planes_rad_s[0][1].has_value());
  EXPECT_FALSE(untold.saturation_planes().any_plane_found());
  // one sign alone leaves offset and distance uncertain, and determines their sum
  planes.sensing_axis[0] = plane;
  planes.sensing_axis[0]->covariance.bottomRightCorner<2, 2>() << 4e-2, -4e-2, -4e-2, 4e-2;
  untold.keep_prior_planes(planes);
  EXPECT_TRUE(untold.gyro_saturation_planes_rad_s[0][1].has_value());
}

// A plane from a few readings, one of them a partial one, stated slopes to 5e-4 that were wrong by 0.02: the next run
// on the device used them and was wrong by twice as much.
TEST_F(RigCalibrationFile, SlopesOfUncertainPlanesHaveALargeCovariance) {
  SaturationPlane plane;
  plane.row = {1.0, 0.0244, 0.0107};
  plane.saturation_limit_rad_s = 10.21;
  plane.samples = {0, 11};
  plane.log_odds = 5.5;
  plane.covariance.diagonal() << 1e-8, 2.5e-7, 1e-6, 1e-6;
  SaturationPlanes planes;
  planes.sensing_axis[0] = plane;
  CalibratedRig unsure = example(), sure = example();
  unsure.keep_prior_planes(planes);
  EXPECT_FALSE(unsure.saturation_planes().sensing_axis[0].has_value());
  const Eigen::Index at = RigConstants::kGyroMisalignment;
  for (Eigen::Index i = at; i < at + 2; ++i) EXPECT_GT(std::sqrt(unsure.calibration.covariance(i, i)), 0.03);
  EXPECT_EQ(unsure.calibration.covariance(at + 2, at + 2), example().calibration.covariance(at + 2, at + 2));
  planes.sensing_axis[0]->log_odds = 20.0;
  sure.keep_prior_planes(planes);
  EXPECT_TRUE(sure.saturation_planes().sensing_axis[0].has_value());
  EXPECT_EQ(sure.calibration.covariance, example().calibration.covariance);
}

TEST_F(RigCalibrationFile, MissingFilesAndFoldersAreBadInput) {
  EXPECT_THROW(read_rig_calibration(folder_ / "nothing.json"), BadInput);
  EXPECT_THROW(write_rig_calibration(folder_ / "no" / "folder.json", example()), BadInput);
}

TEST_F(RigCalibrationFile, TheNextRunStartsFromIt) {
  AngularRateSmoother::Params params;
  start_from_calibration(example(), 4.0, params);
  ASSERT_TRUE(params.model.calibration.has_value());
  EXPECT_TRUE(params.model.calibration->constants == example().calibration.constants);
  EXPECT_DOUBLE_EQ(params.model.calibration->covariance(3, 3), 2.8e-4);
  EXPECT_EQ(params.saturation_detector.stated_gyro_range_rad_s.value_or(0.0), 10.4);
  EXPECT_FALSE(params.saturation_detector.stated_accel_range_m_s2.has_value());
  ASSERT_TRUE(params.calibrated_errors.has_value());
  EXPECT_EQ(params.calibrated_errors->errors.accel_delay_s, 0.0041);
  EXPECT_DOUBLE_EQ(params.calibrated_errors->covariance(3, 3), 4e-6);
  EXPECT_NO_THROW(AngularRateSmoother{params});
  EXPECT_THROW(start_from_calibration(example(), 0.5, params), std::invalid_argument);
}

}  // namespace
}  // namespace tumble::scenarios
