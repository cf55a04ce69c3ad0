// SPDX-License-Identifier: BSD-3-Clause
// Defaults of methods that the library lacks must be the values in models/.
#include "scenarios/methods/robot_presets.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

/// Returns an attribute of the element of this name in a model's file.
std::string attribute(const std::string& model, const std::string& element, const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(test::source_dir() / "models" / (model + ".xml")).rdbuf();
  const std::regex pattern("name=\"" + element + "\"[^>]*\\b" + name + "=\"([^\"]*)\"");
  const std::string all = text.str();
  std::smatch found;
  return std::regex_search(all, found, pattern) ? found[1].str() : "";
}

Eigen::Vector3d vector_of(const std::string& text) {
  std::istringstream numbers(text);
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  numbers >> out.x() >> out.y() >> out.z();
  EXPECT_TRUE(numbers) << text;
  return out;
}

TEST(RobotPresets, AreThoseOfTheModels) {
  EXPECT_EQ(presets::rig_lever_arm_m(), vector_of(attribute("rig", "mti30", "pos")));
  EXPECT_EQ(std::to_string(presets::kSphereRadius_m), std::to_string(std::stod(attribute("sphere", "shell", "size"))));
  const double plateau = load_data_sheet(DataRoot{test::source_dir()}, "mti30").values().at("gyro_rail_rad_s");
  EXPECT_LT(presets::kRigSaturationPoint_rad_s, plateau);
  EXPECT_GT(presets::kRigSaturationPoint_rad_s, 0.99 * plateau);
  // negative control
  EXPECT_NE(presets::rig_lever_arm_m(), vector_of(attribute("rig", "vn100", "pos")));
  EXPECT_EQ(attribute("rig", "nothing", "pos"), "");
}

}  // namespace
}  // namespace tumble::scenarios
