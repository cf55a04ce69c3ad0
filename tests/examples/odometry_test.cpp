// SPDX-License-Identifier: BSD-3-Clause
// Runs the programs of README and tutorial on recordings and compares their poses with the truth.
#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/recording.hpp"
#include "stand_ins/short_scenario.hpp"
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string out;
  std::array<char, 4096> buffer;
  while (pipe && fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) out += buffer.data();
  return out;
}

/// Writes the sensors of a recording as examples/odometry/driver.hpp reads them, all IMUs except the reference. Each
/// sweep is stated to begin `early_ns` before its true start, with matching point times.
void write_messages(const sim::Sensors& sensors, const fs::path& file, std::int64_t early_ns = 0) {
  std::vector<std::vector<ImuSample>> units;
  for (const sim::ImuRecord& record : sensors.imus) {
    if (record.name == "imu_reference") continue;
    ASSERT_TRUE(bridge::imu_samples(record, units.emplace_back()).ok());
  }
  std::ofstream out(file);
  out.precision(17);
  std::size_t next = 0;
  const std::size_t sweeps = sensors.lidars.empty() ? 0 : bridge::sweep_count(sensors.lidars.front());
  for (std::size_t k = 0; k < units.front().size(); ++k) {
    for (const std::vector<ImuSample>& unit : units) {
      const ImuSample& s = unit[k];
      out << "imu " << s.time_ns << ' ' << s.angular_velocity_rad_s.transpose() << ' '
          << s.specific_force_m_s2.transpose() << '\n';
    }
    for (; next < sweeps; ++next) {
      const bridge::Sweep sweep = bridge::sweep(sensors.lidars.front(), next);
      if (sweep.end_ns > units.front()[k].time_ns) break;
      out << "sweep " << sweep.start_ns - early_ns << ' ' << sweep.end_ns << ' ' << sweep.points.size() << '\n';
      out.precision(9);  // enough digits for single precision
      for (const LidarPoint& p : sweep.points)
        out << p.position_L_m.transpose() << ' ' << p.offset_ns + early_ns << ' ' << p.ring << '\n';
      out.precision(17);
    }
  }
}

struct Line {
  std::int64_t time_ns;
  Vector3d p_m;
  double sigma_m;
};
std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> out;
  std::istringstream in(text);
  for (std::string row; std::getline(in, row);) {
    std::istringstream words(row);
    Line line;
    double q = 0.0;
    words >> line.time_ns >> line.p_m.x() >> line.p_m.y() >> line.p_m.z() >> q >> q >> q >> q >> line.sigma_m;
    if (words) out.push_back(line);
  }
  return out;
}

/// Returns how far a body-fixed point has moved from the start to `time_ns` [m].
double distance_m(const sim::Truth& truth, const Vector3d& p_B_m, std::int64_t time_ns) {
  const auto k = std::min(static_cast<std::size_t>(time_ns / truth.period_ns), truth.p_WB_m.size() - 1);
  const auto at = [&](std::size_t i) { return Vector3d(truth.p_WB_m[i] + truth.q_WB[i] * p_B_m); };
  return (at(k) - at(0)).norm();
}

struct Recorded {
  fs::path file, messages;
  sim::Sensors sensors;
  sim::Truth truth;
};
Recorded record(const std::string& scenario) {
  Recorded out;
  const fs::path folder = fs::path(testing::TempDir()) / ("tumble_odometry_" + scenario);
  fs::remove_all(folder);
  fs::create_directories(folder);
  out.file = folder / "recording.h5";
  out.messages = folder / "messages.txt";
  output_of(test::program().string() + " record " + test::write_short_scenario(scenario, folder).string() +
            " --seed 1 --quiet -o " + out.file.string());
  out.sensors = read_sensors(out.file);
  out.truth = read_truth(out.file);
  write_messages(out.sensors, out.messages);
  return out;
}

/// Returns the recording of `hill` that two tests use.
const Recorded& recorded_hill() {
  static const Recorded hill = record("hill");
  return hill;
}

TEST(OdometryExamples, TheTumblingExampleFollowsATumbleAndABagSaysTheSame) {
  const Recorded& hill_1 = recorded_hill();
  const std::vector<Line> lines = lines_of(output_of(std::string(TUMBLE_TUMBLING) + " < " + hill_1.messages.string()));
  ASSERT_GT(lines.size(), 30u);
  const Line& end = lines.back();
  const double distance = distance_m(hill_1.truth, hill_1.truth.imus.front().T_BI.translation(), end.time_ns);
  EXPECT_GT(distance, 1.0) << "a tumble that goes nowhere tells nothing";
  EXPECT_NEAR(end.p_m.norm(), distance, 0.3);
  EXPECT_GT(end.sigma_m, 0.0);

  const fs::path bag = hill_1.file.parent_path() / "hill.mcap";
  output_of(test::program().string() + " export " + hill_1.file.string() + " --format mcap -o " + bag.string());
  const std::vector<Line> from_bag = lines_of(output_of(std::string(TUMBLE_BAG) + " " + bag.string()));
  ASSERT_EQ(from_bag.size(), lines.size());
  EXPECT_LT((from_bag.back().p_m - end.p_m).norm(), 1e-9);
  // The bag does not state the lever arm, so the whole recording is less accurate here: measured difference 0.23 m.
  const std::vector<Line> whole = lines_of(output_of(std::string(TUMBLE_BAG_MAP) + " " + bag.string()));
  ASSERT_GT(whole.size(), lines.size());
  EXPECT_NEAR(whole.back().p_m.norm(), end.p_m.norm(), 0.4);
  EXPECT_NE(std::system((std::string(TUMBLE_BAG) + " " + hill_1.file.string() + " 2>/dev/null").c_str()), 0);
}

// stamps of a real lidar's sweeps have jitter: 50 us are some points of a sweep, not its end
TEST(OdometryExamples, SweepsThatOverlapALittleArePlacedAllTheSame) {
  const Recorded& hill_1 = recorded_hill();
  const fs::path early = hill_1.file.parent_path() / "early.txt";
  write_messages(hill_1.sensors, early, 50'000);
  const auto lines = [](const fs::path& messages) {
    return lines_of(output_of(std::string(TUMBLE_TUMBLING) + " < " + messages.string()));
  };
  const std::vector<Line> regular = lines(hill_1.messages), overlapping = lines(early);
  ASSERT_GT(regular.size(), 30u);
  ASSERT_EQ(overlapping.size(), regular.size());
  EXPECT_LT((overlapping.back().p_m - regular.back().p_m).norm(), 0.02);
  EXPECT_NEAR(overlapping.back().p_m.norm(), regular.back().p_m.norm(), 0.02);
}

TEST(OdometryExamples, TheRollingExampleFollowsARoll) {
  const Recorded roll_1 = record("roll");
  const std::vector<Line> lines = lines_of(output_of(std::string(TUMBLE_ROLLING) + " < " + roll_1.messages.string()));
  ASSERT_GT(lines.size(), 100u);
  const double distance = distance_m(roll_1.truth, roll_1.truth.p_BG_m, lines.back().time_ns);
  EXPECT_NEAR(lines.back().p_m.norm(), distance, 0.02 * std::max(1.0, distance));
}

TEST(OdometryExamples, TheRebootExampleStartsAtTheSavedPose) {
  const Recorded stroll_1 = record("stroll");
  const fs::path folder = stroll_1.file.parent_path();
  // the messages in two parts: split between two IMU messages while the rig is carried
  std::ifstream all(stroll_1.messages);
  std::vector<std::string> lines;
  for (std::string line; std::getline(all, line);) lines.push_back(line);
  std::size_t half = lines.size() / 2;
  while (!lines[half].starts_with("imu")) ++half;
  std::ofstream first(folder / "first.txt"), second(folder / "second.txt");
  for (std::size_t k = 0; k < lines.size(); ++k) (k < half ? first : second) << lines[k] << '\n';
  first.close();
  second.close();
  const auto poses = [&](const char* messages, const char* state) {
    return output_of(std::string(TUMBLE_REBOOT) + " " + (folder / state).string() + " < " +
                     (folder / messages).string() + " 2> " + (folder / "errors.txt").string());
  };
  const std::vector<Line> before = lines_of(poses("first.txt", "parts")),
                          after = lines_of(poses("second.txt", "parts"));
  EXPECT_EQ(test::read_file(folder / "errors.txt"), "");
  ASSERT_GT(before.size(), 3u);
  ASSERT_GT(after.size(), 3u);
  // negative controls: without the state the run starts at the origin, and an invalid state is reported
  std::ofstream beginning(folder / "beginning.txt");
  for (std::size_t k = half; k < half + (lines.size() - half) / 2; ++k) beginning << lines[k] << '\n';
  beginning.close();
  const std::vector<Line> anew = lines_of(poses("beginning.txt", "none"));
  ASSERT_GT(anew.size(), 1u);
  const Vector3d saved_m = before.back().p_m;
  EXPECT_LT((after.front().p_m - saved_m).norm(), 0.5 * (anew.front().p_m - saved_m).norm());
  std::ofstream(folder / "damaged") << "no state";
  poses("beginning.txt", "damaged");
  std::ostringstream errors;
  errors << std::ifstream(folder / "errors.txt").rdbuf();
  EXPECT_NE(errors.str().find("starts without the saved state: insufficient_data"), std::string::npos);
  EXPECT_NE(errors.str().find("damaged was not changed"), std::string::npos);
  EXPECT_EQ(test::read_file(folder / "damaged"), "no state");
  EXPECT_FALSE(fs::exists(folder / "parts.new"));
}

/// Returns the text of a file between its first include and its end.
std::string code_of(const std::string& text) {
  const std::size_t at = text.find("#include");
  return at == std::string::npos ? "" : text.substr(at);
}

TEST(OdometryExamples, ReadmeShowsTheProgramThatIsTested) {
  const fs::path root = test::source_dir();
  const std::string code = code_of(test::read_file(root / "examples/odometry/tumbling.cpp"));
  ASSERT_GT(code.size(), 500u);
  EXPECT_LT(std::count(code.begin(), code.end(), '\n'), 36);
  EXPECT_NE(test::read_file(root / "README.md").find("```cpp\n" + code + "```"), std::string::npos)
      << "README shows another tumbling.cpp";
}

}  // namespace
}  // namespace tumble::scenarios
