// SPDX-License-Identifier: BSD-3-Clause
// The test counts how often one draw composes its world, from the simulation over the scores of maps to the pictures:
// only composing opens the robot's MJCF file, so the test counts how often that file is opened.
#include <sys/inotify.h>
#include <unistd.h>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/scenarios/testing.hpp"
#include "tools/examples/make_example.hpp"

namespace tumble::tools {
namespace {

constexpr const char* kShort = R"(name: short
doc: A short tumble with a lidar.
duration_s: 3
world: {type: hill}
robot: {type: rig}
motion: {type: push, rest_s: 0.5}
sensors:
  - {name: imu, kind: imu, device: mti30, site: mti30}
  - {name: lidar, kind: spinning_lidar, device: rs16, site: rs16}
)";

/// Openings counts how often any process opens a file from now on.
class Openings {
 public:
  /// Closings are watched too, because the kernel merges equal events that follow each other.
  explicit Openings(const fs::path& file) : fd_(inotify_init1(IN_NONBLOCK)) {
    if (fd_ < 0 || inotify_add_watch(fd_, file.c_str(), IN_OPEN | IN_CLOSE) < 0) throw std::runtime_error("inotify");
  }
  ~Openings() { close(fd_); }
  Openings(const Openings&) = delete;
  Openings& operator=(const Openings&) = delete;

  /// Returns the number of openings since the last call.
  int count() {
    std::array<inotify_event, 64> events;  // events without names, because a file is watched, not a folder
    int opened = 0;
    for (ssize_t size = 0; (size = read(fd_, events.data(), sizeof events)) > 0;) {
      const auto read_now = events.begin() + size / static_cast<ssize_t>(sizeof(inotify_event));
      opened += static_cast<int>(
          std::count_if(events.begin(), read_now, [](const auto& event) { return (event.mask & IN_OPEN) != 0; }));
    }
    return opened;
  }

 private:
  int fd_;
};

class BuiltOnce : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    write("scenarios/catalogue/short.yaml", kShort);
    fs::copy(test::source_dir() / "models", folder_ / "models", fs::copy_options::recursive);
  }
  scenarios::DataRoot data() const { return {folder_}; }
};

TEST_F(BuiltOnce, OneDrawComposesItsWorldOnceFromSimulationToPictures) {
  const scenarios::Scenario scenario = scenarios::load_scenario(data(), "short");
  Openings openings(data().models() / "rig.xml");
  const sim::BuiltSituation one(scenarios::draw(data(), scenario, 1), data().models());
  const int of_one = openings.count();
  ASSERT_GT(of_one, 0) << "or composing is not seen";
  for (int k = 0; k < 2; ++k) sim::BuiltSituation(scenarios::draw(data(), scenario, 1), data().models());
  ASSERT_EQ(openings.count(), 2 * of_one) << "or what is composed twice is not seen";

  const std::vector<std::string> names = {"rate/raw", "slam/icp_raw"};
  const scenarios::RunResult run = scenarios::run_situation(data(), scenario, 1, scenarios::find_methods(names), 1);
  const Example example = example_of(run, Moving::left_out);
  EXPECT_EQ(openings.count(), of_one);
  ASSERT_NE(run.surface, nullptr);
  for (const scenarios::Outcome& outcome : run.outcomes) EXPECT_EQ(outcome.status, scenarios::OutcomeStatus::ok);
  EXPECT_EQ(example.pictures.size(), 3u) << "the way, the film and the map against the true surface";
}

}  // namespace
}  // namespace tumble::tools
