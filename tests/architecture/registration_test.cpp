// SPDX-License-Identifier: BSD-3-Clause
// The test finds forgotten registrations of components that consist of a file and a line of registration. Each function
// or constant that a header of such a list declares must be named where the list is created.
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

struct Registry {
  std::string header, returns;  ///< functions with this return type, or constants of this type
  std::string arguments;        ///< functions or constants with these arguments; others create entries for other lists
  std::string list;             ///< the source that must name each function
  std::size_t least;            ///< lower bound of the number of functions, so that the search cannot fail silently
};

std::vector<std::string> declared(const std::string& text, const std::string& returns, const std::string& arguments) {
  const std::regex function("(?:^|\n)" + returns + R"( ([a-z0-9_]+)[({])" + arguments + R"([)}];)");
  std::vector<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), function), end; it != end; ++it) out.push_back((*it)[1]);
  return out;
}

std::vector<std::string> left_out(const std::vector<std::string>& names, const std::string& list) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    if (!std::regex_search(list, std::regex("\\b" + name + "\\b"))) out.push_back(name);
  }
  return out;
}

TEST(Registration, NothingThatIsDeclaredIsLeftOut) {
  const std::vector<Registry> registries = {
      {"scenarios/methods/registry.hpp", "Method", "", "scenarios/methods/registry.cpp", 24},
      {"scenarios/scoring/families.hpp", "std::vector<Metric>", "(?:Kind kind)?", "scenarios/scoring/score.cpp", 9},
      {"sim/world/world_type.hpp", "const WorldType&", "", "sim/world/world_type.cpp", 7},
      {"sim/robot/robot_type.hpp", "const RobotType&", "", "sim/robot/robot_type.cpp", 3},
      {"sim/motion/motion_type.hpp", "const MotionType&", "", "sim/motion/motion_type.cpp", 7},
      {"sim/series/series_sensors.hpp", "const SensorType&", "", "sim/sensor_type.cpp", 1},
      {"estimator/include/tumble/odometry/sensor_sheets.hpp", "inline constexpr NamedImu", "[^;]*",
       "python/bindings/sheets.cpp", 16},
      {"estimator/include/tumble/odometry/sensor_sheets.hpp", "inline constexpr NamedImu", "[^;]*",
       "python/src/tumble/sheets.py", 16},
      {"estimator/include/tumble/odometry/sensor_sheets.hpp", "inline constexpr NamedLidar", "[^;]*",
       "python/bindings/sheets.cpp", 12},
      {"estimator/include/tumble/odometry/sensor_sheets.hpp", "inline constexpr NamedLidar", "[^;]*",
       "python/src/tumble/sheets.py", 12},
      {"tools/tumble/verbs.hpp", "Action", "[^;{]*", "tools/tumble/verbs.cpp", 15},
  };
  for (const Registry& registry : registries) {
    const std::vector<std::string> names = declared(
        tumble::test::read_file(tumble::test::source_dir() / registry.header), registry.returns, registry.arguments);
    EXPECT_GE(names.size(), registry.least) << registry.header;
    EXPECT_EQ(left_out(names, tumble::test::read_file(tumble::test::source_dir() / registry.list)),
              std::vector<std::string>())
        << registry.header << " declares what " << registry.list << " does not name";
  }
}

/// Returns the names of the files in a folder of the tree.
std::vector<std::string> stems_in(const std::string& folder) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(tumble::test::source_dir() / folder))
    if (entry.path().extension() == ".yaml") out.push_back(entry.path().stem().string());
  return out;
}

TEST(Registration, TheDesignNamesEveryScenarioAndDevice) {
  const std::string design = tumble::test::read_file(tumble::test::source_dir() / "docs/design.md");
  const std::vector<std::string> scenarios = stems_in("scenarios/catalogue"), devices = stems_in("models/sensors");
  EXPECT_GE(scenarios.size(), 23u);
  EXPECT_GE(devices.size(), 8u);
  EXPECT_EQ(left_out(scenarios, design), std::vector<std::string>());
  EXPECT_EQ(left_out(devices, design), std::vector<std::string>());
}

/// Returns the text of a scenario of the catalogue, and the texts of the scenarios that the scenario extends.
std::string with_base(const std::string& scenario) {
  const std::string text =
      tumble::test::read_file(tumble::test::source_dir() / ("scenarios/catalogue/" + scenario + ".yaml"));
  std::smatch base;
  return std::regex_search(text, base, std::regex("\nextends: ([a-z_]+)\n")) ? text + with_base(base[1]) : text;
}

/// The evalio package cannot call the program when its data sets are listed, so its list must equal the rig scenarios
/// with a lidar.
TEST(Registration, EvalioHasEveryScenarioOfTheRig) {
  const std::string adapter =
      tumble::test::read_file(tumble::test::source_dir() / "python/src/tumble/evalio/recordings.py");
  const std::size_t from = adapter.find("\nSCENARIOS = (");
  ASSERT_NE(from, std::string::npos);
  const std::string listed = adapter.substr(from, adapter.find(')', from) - from);
  std::vector<std::string> of_the_rig, others;
  for (const std::string& name : stems_in("scenarios/catalogue")) {
    const std::string text = with_base(name);
    const bool rig = std::regex_search(text, std::regex("\n  type: rig\\b"));
    (rig && text.find("_lidar") != std::string::npos ? of_the_rig : others).push_back(name);
  }
  EXPECT_GE(of_the_rig.size(), 11u);
  EXPECT_EQ(left_out(of_the_rig, listed), std::vector<std::string>());
  EXPECT_EQ(left_out(others, listed), others) << "one of them is listed, and has no sweeps of a rig";
}

TEST(Registration, CheckerFindsTheForgottenLine) {
  const std::vector<std::string> names = declared(
      "/// One.\nMethod rate_one();\nMethod rate_two();  // two\nMethod made(int n);\nint other();\n", "Method", "");
  EXPECT_EQ(names, (std::vector<std::string>{"rate_one", "rate_two"}));
  EXPECT_EQ(left_out(names, "all = { rate_one(), rate_two_more() }"), std::vector<std::string>{"rate_two"});
}

}  // namespace
