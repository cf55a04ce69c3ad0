// SPDX-License-Identifier: BSD-3-Clause
// The test checks that defaults of methods without a value in the library agree with models/.
#include "scenarios/methods/robot_presets.hpp"

#include "scenarios/draw/data_sheet.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

/// Returns an attribute of the named element in a model's file.
std::string attribute(const std::string& model, const std::string& element, const std::string& name) {
  const std::string text = test::read_file(test::source_dir() / "models" / (model + ".xml"));
  const std::regex pattern("name=\"" + element + "\"[^>]*\\b" + name + "=\"([^\"]*)\"");
  std::smatch found;
  return std::regex_search(text, found, pattern) ? found[1].str() : "";
}

Vector3d vector_of(const std::string& text) {
  std::istringstream numbers(text);
  Vector3d out = Eigen::Vector3d::Zero();
  numbers >> out.x() >> out.y() >> out.z();
  EXPECT_TRUE(numbers) << text;
  return out;
}

TEST(RobotPresets, AreThoseOfTheModels) {
  EXPECT_EQ(presets::rig_lever_arm_m(), vector_of(attribute("rig", "mti30", "pos")));
  EXPECT_EQ(std::to_string(presets::kSphereRadius_m), std::to_string(std::stod(attribute("sphere", "shell", "size"))));
  const double plateau = load_data_sheet(test::tree_data(), "mti30").values().at("gyro_rail_rad_s");
  EXPECT_LT(presets::kRigSaturationPoint_rad_s, plateau);
  EXPECT_GT(presets::kRigSaturationPoint_rad_s, 0.99 * plateau);
  // negative control
  EXPECT_NE(presets::rig_lever_arm_m(), vector_of(attribute("rig", "vn100", "pos")));
  EXPECT_EQ(attribute("rig", "nothing", "pos"), "");
}

}  // namespace
}  // namespace tumble::scenarios
