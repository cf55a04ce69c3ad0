// SPDX-License-Identifier: BSD-3-Clause
// Tests saturation levels of real gyros (RepoIMU), and no levels where a real gyro does not clip (BROAD): published
// files if available, synthetic replacements otherwise.
#include "stand_ins/broad_trial.hpp"
#include "stand_ins/stand_ins.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"

namespace tumble {
namespace {

// Reads columns separated by ';': time, quaternion, specific force, rate, field; two header lines.
std::vector<ImuSample> read_repoimu(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<ImuSample> out;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::vector<double> values;
    while (std::getline(cells, cell, ';')) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      if (end == cell.c_str()) break;
      values.push_back(value);
    }
    if (values.size() < 11) continue;
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(1e9 * values[0]);
    sample.specific_force_m_s2 = {values[5], values[6], values[7]};
    sample.angular_velocity_rad_s = {values[8], values[9], values[10]};
    out.push_back(sample);
  }
  return out;
}

struct Known {
  test::DataFolder folder;
  const char* file;
  int axis;
  double distance, offset, first_slope, second_slope;  // slopes along (axis + 1) % 3 and (axis + 2) % 3
  int samples;                                         // samples at the saturation limit, counted by hand
};

class RealSaturationPlanes : public ::testing::TestWithParam<Known> {};

TEST_P(RealSaturationPlanes, AreFoundWithoutAnybodyStatingThem) {
  const std::vector<ImuSample> samples = read_repoimu(test::written(GetParam().folder) / GetParam().file);
  ASSERT_GT(samples.size(), 1000u);
  const SaturationPlanes planes = SaturationPlaneFinder({}).find(samples);
  const auto axis = static_cast<std::size_t>(GetParam().axis);
  for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(planes.sensing_axis[j].has_value(), j == axis) << j;
  ASSERT_TRUE(planes.sensing_axis[axis].has_value());
  const SaturationPlane& rail = *planes.sensing_axis[axis];
  // 0.3 % lower: fits by hand treated partly saturated windows as clipped
  EXPECT_NEAR(rail.saturation_limit_rad_s, GetParam().distance, 0.003 * GetParam().distance);
  EXPECT_NEAR(rail.offset_rad_s, GetParam().offset, 0.01);
  // the tolerance is the difference of such fits between recordings of one device
  EXPECT_NEAR(rail.row[(GetParam().axis + 1) % 3], GetParam().first_slope, 0.008);
  EXPECT_NEAR(rail.row[(GetParam().axis + 2) % 3], GetParam().second_slope, 0.008);
  int clipped = 0;
  for (const ImuSample& sample : samples) {
    const Eigen::Vector3d& reading = sample.angular_velocity_rad_s;
    clipped += rail.is_saturated(reading, -1) || rail.is_saturated(reading, 1) ? 1 : 0;
  }
  EXPECT_NEAR(clipped, GetParam().samples, 0.06 * GetParam().samples);
}

std::vector<Known> known_rails() {
  const std::vector<test::DataFolder> folders = test::data_folders("repoimu");
  const test::WandRail made;
  std::vector<Known> all = {{folders.front(), test::kStandInWand, 0, made.distance_rad_s, made.offset_rad_s,
                             -made.y_slope, -made.z_slope, test::stand_in_wand_clipped()}};
  if (folders.size() == 1) return all;
  const test::DataFolder& real = folders.back();
  all.push_back({real, "TStick_Test05_Trial1.csv", 0, 7.2987, -0.046, -0.006, 0.0181, 1509});
  all.push_back({real, "TStick_Test10_Trial1.csv", 0, 7.3041, -0.058, -0.001, 0.0209, 215});
  all.push_back({real, "Pendulum_Test02a_Trial1_Segment_3.csv", 2, 10.2935, 0.0, -0.0515, 0.003, 98});
  all.push_back({real, "Pendulum_Test07_Trial3_Segment_3.csv", 2, 10.2935, 0.0, -0.0515, 0.003, 42});
  return all;
}

INSTANTIATE_TEST_SUITE_P(RepoImu, RealSaturationPlanes, ::testing::ValuesIn(known_rails()));

class UnsaturatedGyro : public ::testing::TestWithParam<std::string> {};

TEST_P(UnsaturatedGyro, AreFoundInARealGyroThatDoesNotClip) {
  const std::vector<ImuSample> samples = testing::read_broad_trial(GetParam()).samples;
  ASSERT_GT(samples.size(), 10000u);
  EXPECT_FALSE(SaturationPlaneFinder({}).find(samples).any_plane_found());
  const SaturationPlaneFinder forces(SaturationPlaneFinder::Params::defaults_for_accelerometer());
  EXPECT_FALSE(forces.find(samples, Triad::accelerometer).any_plane_found());
}

INSTANTIATE_TEST_SUITE_P(Broad, UnsaturatedGyro, ::testing::ValuesIn(testing::broad_trials()));

}  // namespace
}  // namespace tumble
