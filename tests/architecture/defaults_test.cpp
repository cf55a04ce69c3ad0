// SPDX-License-Identifier: BSD-3-Clause
// The library must know no robot and no simulated run of the harness: its defaults, code and comments contain no number
// of models/*.xml or of a data sheet, no device of these robots and no seed. The data sheets of devices
// (odometry/sensor_sheets) are excepted, because users select these presets by name.
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

using tumble::test::read_file;

std::vector<std::string> all_of(const std::string& text, const char* pattern) {
  const std::regex wanted(pattern, std::regex::icase);
  std::vector<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), wanted), end; it != end; ++it) out.push_back((*it)[1]);
  return out;
}

const char* const kNumber = R"((?:^|[^\w.])([0-9]+\.?[0-9]*(?:e-?[0-9]+)?)(?![\w.]))";

/// Returns the digits of a number without sign, point, exponent and zeros at either end: 145 for 0.0145.
std::string digits_of(const std::string& number) {
  std::string out = std::regex_replace(number.substr(0, number.find_first_of("eE")), std::regex("[^0-9]"), "");
  out.erase(0, out.find_first_not_of('0'));
  out.erase(out.find_last_not_of('0') + 1);
  return out;
}

/// Returns numbers of three or more digits from a robot or a data sheet, except gravity and powers of two, which are
/// also sizes of arrays.
std::set<double> distinctive(const std::vector<std::string>& numbers) {
  constexpr double kGravity_m_s2 = 9.80665;
  std::set<double> out;
  for (const std::string& number : numbers) {
    const double value = std::abs(std::stod(number));
    const bool power_of_two = value > 0.0 && std::exp2(std::round(std::log2(value))) == value;
    if (digits_of(number).size() >= 3 && value != kGravity_m_s2 && !power_of_two) out.insert(value);
  }
  return out;
}

struct Known {
  std::set<double> numbers;
  std::vector<std::vector<double>> places;  ///< positions of sensors and parts
  std::regex names;                         ///< names of the devices on the robots
  std::regex draws;                         ///< for example "hill 3004"
};

Known known() {
  const fs::path root = tumble::test::source_dir();
  Known out;
  std::vector<std::string> numbers;
  std::string names;
  for (const char* robot : {"rig", "sphere"}) {
    const std::string model = read_file(root / "models" / (std::string(robot) + ".xml"));
    for (const std::string& place : all_of(model, R"re(pos="([^"]*)")re")) {
      std::istringstream coordinates(place);
      std::vector<double> at(3);
      for (double& coordinate : at) coordinates >> coordinate;
      const auto set = std::count_if(at.begin(), at.end(), [](double x) { return x != 0.0; });
      if (set >= 2) out.places.push_back(at);
    }
    for (const std::string& size : all_of(model, R"re(type="sphere" size="([^"]*)")re")) numbers.push_back(size);
    for (std::string device : all_of(model, R"re(<site name="([a-z]+[0-9]*))re")) {
      device = std::regex_replace(device, std::regex("([a-z])([0-9])"), "$1-?$2");
      names += (names.empty() ? "" : "|") + device;
    }
  }
  for (const auto& sheet : fs::directory_iterator(root / "models" / "sensors")) {
    for (const std::string& value : all_of(read_file(sheet.path()), R"(value: *([-0-9.e]+))")) numbers.push_back(value);
  }
  out.numbers = distinctive(numbers);
  out.names = std::regex("\\b(" + names + ")(?![0-9])", std::regex::icase);
  std::string scenarios;
  for (const auto& scenario : fs::directory_iterator(root / "scenarios" / "catalogue"))
    scenarios += (scenarios.empty() ? "" : "|") + scenario.path().stem().string();
  out.draws = std::regex("(\\b(" + scenarios + ")`?,? +[0-9]{3,}|\\bseeds? +[0-9]+)");
  return out;
}

/// Returns what a source of the library mentions of the robots and simulated runs of the harness.
std::vector<std::string> told_by(const std::string& source, const Known& known) {
  std::vector<std::string> out;
  const std::string code = std::regex_replace(source, std::regex("//[^\n]*"), "");
  const std::vector<std::string> written = all_of(code, kNumber);
  std::vector<double> values;
  for (const std::string& number : written) {
    values.push_back(std::stod(number));
    if (known.numbers.contains(values.back())) out.push_back(number);
  }
  for (const std::vector<double>& place : known.places) {
    const auto same = [](double a, double b) { return a == std::abs(b); };
    if (std::search(values.begin(), values.end(), place.begin(), place.end(), same) != values.end())
      out.push_back("the place " + std::to_string(place[0]) + " " + std::to_string(place[1]) + " " +
                    std::to_string(place[2]));
  }
  std::smatch found;
  if (std::regex_search(source, found, known.names)) out.push_back(found[0]);
  if (std::regex_search(source, found, known.draws)) out.push_back(found[0]);
  return out;
}

TEST(Defaults, OfTheLibraryKnowNoRobotAndNoDraw) {
  const Known harness = known();
  EXPECT_GT(harness.numbers.size(), 50u);
  EXPECT_GE(harness.places.size(), 5u);
  const std::string sheets = "sensor_sheets";
  std::size_t sources = 0;
  for (const char* folder : {"estimator/include", "estimator/src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder)) {
      const std::string extension = entry.path().extension().string();
      if ((extension != ".hpp" && extension != ".cpp") || entry.path().stem() == sheets) continue;
      ++sources;
      for (const std::string& told : told_by(read_file(entry.path()), harness))
        ADD_FAILURE() << entry.path().string() << ": " << told;
    }
  }
  EXPECT_GT(sources, 150u);
}

TEST(Defaults, OneThatDoesIsFound) {
  const Known harness = known();
  for (const char* source :
       {"BodyImuConstants nominal = {.lever_arm_m = {-0.022, -0.085, 0.055}};", "double radius_m = 0.145;",
        "/// Noise density (MTi-30: 0.03 deg/s/sqrt(Hz)).", "/// behind the VN-100", "double gyro_range = 7.853981634;",
        "// tried: cliff 15075 from 22.6 m to 7.6 cm", "// the draws of seed 9", "kDepth_m = 0.04638; // a mirror"})
    EXPECT_FALSE(told_by(source, harness).empty()) << source;
  for (const char* source :
       {"double gravity_m_s2 = 9.80665;", "double rough_share = 0.055;", "/// MTi-300 sheet: 0.05 deg",
        "double radius_m = 0.0;  ///< has no default", "const BodyImuConstants place{.lever_arm_m = p_I_m};"})
    EXPECT_TRUE(told_by(source, harness).empty()) << source;
}

}  // namespace
