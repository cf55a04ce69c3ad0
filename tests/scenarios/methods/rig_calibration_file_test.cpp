// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rig_calibration_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "scenarios/errors.hpp"
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
    rig.calibration.constants.elements << 0.05, -0.01, 1e-3, 0.0, 0.02, -0.03;
    rig.calibration.covariance = 0.7e-4 * RigConstants::Matrix::Identity();
    rig.calibration.covariance(0, 4) = rig.calibration.covariance(4, 0) = 2e-7;
    rig.rail = {10.5, std::nullopt, 10.4, std::nullopt, std::nullopt, std::nullopt};
    rig.gyro_planes_rad_s[2] = {-10.25, 10.55};
    rig.accelerometer_planes_m_s2[0] = {std::nullopt, 77.5};
    rig.accelerometer_elements << 0.016, -0.0026, 0.0, 0.0, 0.0, 0.0;
    rig.device_errors = KnownSensorErrors{};
    rig.device_errors->errors.accel_delay_s = 0.0041;
    rig.device_errors->errors.g_sensitivity_s_m(2, 0) = -1.3e-4;
    rig.device_errors->covariance = 1e-6 * SensorErrors::Matrix::Identity();
    rig.device_errors->covariance(0, 27) = rig.device_errors->covariance(27, 0) = 3e-7;
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
    try {
      read_rig_calibration(path());
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(RigCalibrationFile, ComesBackTheSameToTheBit) {
  write_rig_calibration(path(), example());
  const CalibratedRig back = read_rig_calibration(path());
  EXPECT_TRUE(back.calibration.constants == example().calibration.constants);
  EXPECT_EQ(back.calibration.covariance, example().calibration.covariance);
  EXPECT_EQ(back.rail, example().rail);
  EXPECT_EQ(back.gyro_planes_rad_s, example().gyro_planes_rad_s);
  EXPECT_TRUE(back.planes() == example().planes());
  EXPECT_EQ(back.accelerometer_planes_m_s2, example().accelerometer_planes_m_s2);
  EXPECT_TRUE(back.planes(Triad::accelerometer) == example().planes(Triad::accelerometer));
  ASSERT_TRUE(back.planes(Triad::accelerometer).element[0].has_value());
  EXPECT_EQ(back.planes(Triad::accelerometer).element[0]->row, Eigen::Vector3d(1.0, 0.016, -0.0026));
  EXPECT_TRUE(back.planes(Triad::accelerometer).element[0]->seen(1));
  EXPECT_FALSE(back.planes(Triad::accelerometer).element[0]->seen(-1));
  ASSERT_TRUE(back.device_errors.has_value());
  EXPECT_TRUE(back.device_errors->errors == example().device_errors->errors);
  EXPECT_EQ(back.device_errors->covariance, example().device_errors->covariance);
  EXPECT_FALSE(back.planes().element[0].has_value());
  ASSERT_TRUE(back.planes().element[2].has_value());
  EXPECT_NEAR(back.planes().element[2]->distance_rad_s, 10.4, 1e-12);
  EXPECT_NEAR(back.planes().element[2]->offset_rad_s, 0.15, 1e-12);
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
TEST_F(RigCalibrationFile, PlanesWhoseLevelIsNotToldAreNotHandedOn) {
  RailPlane plane;
  plane.row = {1.0, 0.05, 0.0};
  plane.distance_rad_s = 10.2;
  plane.samples = {0, 11};
  plane.log_odds = 20.0;
  plane.covariance.diagonal() << 4e-6, 4e-6, 2e-6, 2e-6;
  RailPlanes planes;
  planes.element[0] = plane;
  CalibratedRig told, untold;
  told.keep(planes);
  EXPECT_EQ(told.gyro_planes_rad_s[0][1].value_or(0.0), 10.2);
  EXPECT_FALSE(told.gyro_planes_rad_s[0][0].has_value());
  // a slope that is uncertain by 0.03, where the other axis read 10, leaves the level uncertain by 0.3
  planes.element[0]->covariance(1, 1) = 9e-4;
  planes.element[0]->covariance(1, 2) = planes.element[0]->covariance(2, 1) = 9e-3;
  planes.element[0]->covariance(2, 2) = 9e-2;
  untold.keep(planes);
  EXPECT_FALSE(untold.gyro_planes_rad_s[0][1].has_value());
  EXPECT_FALSE(untold.planes().any());
  // one sign alone leaves offset and distance uncertain, and determines their sum
  planes.element[0] = plane;
  planes.element[0]->covariance.bottomRightCorner<2, 2>() << 4e-2, -4e-2, -4e-2, 4e-2;
  untold.keep(planes);
  EXPECT_TRUE(untold.gyro_planes_rad_s[0][1].has_value());
}

// A plane from a few readings, one of them a partial one, stated slopes to 5e-4 that were wrong by 0.02: the next run
// on the device used them and was wrong by twice as much.
TEST_F(RigCalibrationFile, SlopesOfUnsurePlanesAreDoubted) {
  RailPlane plane;
  plane.row = {1.0, 0.0244, 0.0107};
  plane.distance_rad_s = 10.21;
  plane.samples = {0, 11};
  plane.log_odds = 5.5;
  plane.covariance.diagonal() << 1e-8, 2.5e-7, 1e-6, 1e-6;
  RailPlanes planes;
  planes.element[0] = plane;
  CalibratedRig unsure = example(), sure = example();
  unsure.keep(planes);
  EXPECT_FALSE(unsure.planes().element[0].has_value());
  const Eigen::Index at = RigConstants::kElements;
  for (Eigen::Index i = at; i < at + 2; ++i) EXPECT_GT(std::sqrt(unsure.calibration.covariance(i, i)), 0.03);
  EXPECT_EQ(unsure.calibration.covariance(at + 2, at + 2), example().calibration.covariance(at + 2, at + 2));
  planes.element[0]->log_odds = 20.0;
  sure.keep(planes);
  EXPECT_TRUE(sure.planes().element[0].has_value());
  EXPECT_EQ(sure.calibration.covariance, example().calibration.covariance);
}

TEST_F(RigCalibrationFile, MissingFilesAndFoldersAreBadInput) {
  EXPECT_THROW(read_rig_calibration(folder_ / "nothing.json"), BadInput);
  EXPECT_THROW(write_rig_calibration(folder_ / "no" / "folder.json", example()), BadInput);
}

TEST_F(RigCalibrationFile, TheNextRunStartsFromIt) {
  RateSmoother::Params params;
  start_from(example(), 4.0, params);
  ASSERT_TRUE(params.model.calibration.has_value());
  EXPECT_TRUE(params.model.calibration->constants == example().calibration.constants);
  EXPECT_DOUBLE_EQ(params.model.calibration->covariance(3, 3), 2.8e-4);
  EXPECT_EQ(params.rails.stated_gyro_rad_s.value_or(0.0), 10.4);
  EXPECT_FALSE(params.rails.stated_accel_m_s2.has_value());
  ASSERT_TRUE(params.calibrated_errors.has_value());
  EXPECT_EQ(params.calibrated_errors->errors.accel_delay_s, 0.0041);
  EXPECT_DOUBLE_EQ(params.calibrated_errors->covariance(3, 3), 4e-6);
  EXPECT_NO_THROW(RateSmoother{params});
  EXPECT_THROW(start_from(example(), 0.5, params), std::invalid_argument);
}

}  // namespace
}  // namespace tumble::scenarios
