// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/magnetometer.hpp"

#include "sim/imu/imu_simulation.hpp"
#include "tests/sim/imu/simulated_imu.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

Values numbers(const std::map<std::string, double>& given) {
  Values values = resolve("imu", {}, imu_parameters());
  for (const auto& [name, value] : given) values.set(name, value);
  return values;
}

std::vector<Vector3d> straight_path() {
  std::vector<Vector3d> path;
  for (int k = 0; k <= 1000; ++k) path.emplace_back(0.005 * k, 0, 0.1);
  return path;
}

TEST(MagneticField, OfADipoleAgreesWithTheTextbook) {
  MagneticField field;
  field.dipoles.push_back({{1, 2, 3}, {0, 0, 5.0}});
  // on the axis the field is mu_0 m / (2 pi d^3), and to the side half of that against the moment (Jackson 5.56 with r
  // along and across m)
  EXPECT_NEAR((field.at({1, 2, 3.5}) - Vector3d(0, 0, 2e-7 * 5.0 / 0.125)).norm(), 0.0, 1e-18);
  EXPECT_NEAR((field.at({1.5, 2, 3}) - Vector3d(0, 0, -1e-7 * 5.0 / 0.125)).norm(), 0.0, 1e-18);
}

TEST(MagneticField, OfADipoleHasNoSourceAndNoCurl) {
  MagneticField field;
  field.dipoles.push_back({{0.1, -0.2, 0}, {1.0, 2.0, -3.0}});
  const Vector3d p(0.6, 0.3, 0.5);
  constexpr double h = 1e-4;
  Matrix3d gradient;
  for (int j = 0; j < 3; ++j)
    gradient.col(j) = (field.at(p + h * Vector3d::Unit(j)) - field.at(p - h * Vector3d::Unit(j))) / (2 * h);
  EXPECT_NEAR(gradient.trace() / gradient.norm(), 0.0, 1e-6);
  EXPECT_NEAR((gradient - gradient.transpose()).norm() / gradient.norm(), 0.0, 1e-6);
}

TEST(MagneticField, EarthDipsAndPointsNorth) {
  const Values values = numbers({{"earth_field_t", 5e-5}, {"earth_inclination_rad", 1.0}, {"earth_north_rad", 0.5}});
  const MagneticField field = draw_magnetic_field(values, straight_path(), 1);
  EXPECT_TRUE(field.dipoles.empty());
  EXPECT_NEAR(field.earth_W_t.norm(), 5e-5, 1e-18);
  EXPECT_LT(field.earth_W_t.z(), 0.0);
  EXPECT_NEAR(std::atan2(field.earth_W_t.y(), field.earth_W_t.x()), 0.5, 1e-12);
  EXPECT_NEAR(std::asin(-field.earth_W_t.z() / 5e-5), 1.0, 1e-12);
}

TEST(MagneticField, SourcesKeepTheirDistanceAndFollowTheSeed) {
  const Values values = numbers({{"magnetic_sources", 30}, {"magnetic_source_moment_a_m2", 5.0}});
  const std::vector<Vector3d> path = straight_path();
  const MagneticField field = draw_magnetic_field(values, path, 7);
  ASSERT_EQ(field.dipoles.size(), 30u);
  for (const MagneticDipole& dipole : field.dipoles) {
    double nearest_m = 1e9;
    for (const Vector3d& p : path) nearest_m = std::min(nearest_m, (p - dipole.p_W_m).norm());
    EXPECT_GE(nearest_m, 0.4 - 0.01);  // compared with every other position of the path, 1 cm apart
    EXPECT_LE(nearest_m, 1.5);
    EXPECT_GE(dipole.moment_W_a_m2.norm(), 5.0 / 3.0 - 1e-12);
    EXPECT_LE(dipole.moment_W_a_m2.norm(), 15.0 + 1e-12);
  }
  EXPECT_EQ(draw_magnetic_field(values, path, 7).dipoles[3].p_W_m, field.dipoles[3].p_W_m);
  EXPECT_NE(draw_magnetic_field(values, path, 8).dipoles[3].p_W_m, field.dipoles[3].p_W_m);
}

TEST(Magnetometer, OffReadsTheTrueFieldBitForBit) {
  Magnetometer ideal(numbers({}), 1, "imu.mag");
  const Vector3d field(1e-5, 1e-5 / 3.0, -4e-5);
  for (int k = 0; k < 5; ++k) ASSERT_EQ(ideal.read(field), field);
}

TEST(Magnetometer, ErrorsHaveTheirSizes) {
  double hard = 0.0, noise = 0.0;
  constexpr int kDevices = 1000, kReadings = 20;
  for (int seed = 0; seed < kDevices; ++seed) {
    Magnetometer device(numbers({{"mag_hard_iron_t", 2e-6}, {"mag_noise_t", 5e-8}}), seed, "imu.mag");
    Vector3d mean = Vector3d::Zero();
    std::vector<Vector3d> readings;
    for (int k = 0; k < kReadings; ++k) {
      readings.push_back(device.read(Vector3d::Zero()));
      mean += readings.back() / kReadings;
    }
    hard += mean.squaredNorm();
    for (const Vector3d& reading : readings) noise += (reading - mean).squaredNorm();
  }
  // for 3000 offsets and 57000 degrees of freedom, 5 standard errors are 6.5 % and 1.5 %
  EXPECT_NEAR(std::sqrt(hard / (3 * kDevices)), 2e-6, 0.065 * 2e-6);
  EXPECT_NEAR(std::sqrt(noise / (3 * kDevices * (kReadings - 1))), 5e-8, 0.015 * 5e-8);
}

TEST(Magnetometer, ClipsAndQuantises) {
  Magnetometer device(numbers({{"mag_rail_t", 8e-4}, {"mag_quantum_t", 1e-7}}), 1, "imu.mag");
  const Vector3d reading = device.read({1e-3, -2e-3, 1.23e-6});
  EXPECT_NEAR(reading.x(), 8e-4, 1e-12);
  EXPECT_NEAR(reading.y(), -8e-4, 1e-12);
  EXPECT_NEAR(reading.z(), 1.2e-6, 1e-15);
}

/// Returns a body that turns about z while it moves along x.
Truth turning_along() {
  Truth truth;
  for (int k = 0; k <= 2000; ++k) {
    const double t = k * 0.0005;
    truth.q_WB.emplace_back(Eigen::AngleAxisd(6.0 * t, Vector3d::UnitZ()));
    truth.w_WB_B_rad_s.emplace_back(0, 0, 6);
    truth.v_WB_m_s.emplace_back(2, 0, 0);
    truth.p_WB_m.emplace_back(2 * t, 0, 0);
  }
  return truth;
}

SimulatedImu measured_field(const std::map<std::string, double>& given) {
  SensorSpec sensor;
  sensor.name = "imu";
  sensor.values = numbers(given);
  Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  T_BI.translation() = Vector3d(0.1, 0, 0);
  return simulated(turning_along(), sensor, T_BI, 3);
}

TEST(ImuMagnetometer, IsOffUnlessAskedForAndChangesNothingElse) {
  const SimulatedImu off = measured_field({{"gyro_noise_rad_s_sqrt_hz", 1e-3}});
  EXPECT_TRUE(off.record.magnetic_field_t.empty());
  EXPECT_TRUE(off.truth.magnetic_field_t.empty());
  EXPECT_EQ(off.record.earth_field_W_t, Vector3d::Zero());
  const SimulatedImu on =
      measured_field({{"gyro_noise_rad_s_sqrt_hz", 1e-3}, {"magnetometer", 1}, {"mag_noise_t", 1e-7}});
  EXPECT_EQ(on.record.magnetic_field_t.size(), 100u);
  EXPECT_EQ(on.record.gyro_rad_s, off.record.gyro_rad_s);
}

TEST(ImuMagnetometer, ReadsTheEarthInItsOwnAxes) {
  const SimulatedImu r = measured_field({{"magnetometer", 1}});
  ASSERT_EQ(r.record.magnetic_field_t.size(), 100u);
  EXPECT_EQ(r.record.magnetic_field_t, r.truth.magnetic_field_t);
  for (std::size_t i = 0; i < 100; ++i) {
    // the reading is the mean over a turn of 0.06 rad about z, half a step behind the middle of the window; y of I is z
    // of B
    const double heading = 6.0 * (0.01 * (static_cast<double>(i) + 0.5) + 0.00025);
    const Vector3d& earth = r.record.earth_field_W_t;
    const Vector3d in_B(earth.x() * std::cos(heading), -earth.x() * std::sin(heading), earth.z());
    const Vector3d expected(in_B.x(), in_B.z(), -in_B.y());
    ASSERT_NEAR((r.record.magnetic_field_t[i] - expected).norm() / earth.norm(), 0.0, 1e-4);
  }
}

TEST(ImuMagnetometer, SourcesDisturbTheFieldBesideThePath) {
  const SimulatedImu calm = measured_field({{"magnetometer", 1}}),
                     disturbed = measured_field({{"magnetometer", 1}, {"magnetic_sources", 8}});
  double largest = 0.0, smallest = 1.0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double difference = (disturbed.record.magnetic_field_t[i] - calm.record.magnetic_field_t[i]).norm();
    largest = std::max(largest, difference);
    smallest = std::min(smallest, difference);
  }
  EXPECT_GT(largest, 1e-6);            // a dipole of 5 A m^2 at a metre makes 0.5 to 1 uT
  EXPECT_LT(largest, 2e-4);            // 15 A m^2 at 0.4 m makes 47 uT
  EXPECT_GT(largest, 3.0 * smallest);  // a local disturbance
  EXPECT_EQ(disturbed.record.earth_field_W_t, calm.record.earth_field_W_t);
}

}  // namespace
}  // namespace tumble::sim
