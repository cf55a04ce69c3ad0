// SPDX-License-Identifier: BSD-3-Clause
// rate_statistics SCENARIO FIRST LAST [--method NAME]... [--keep FOLDER] [--worst N] [--exact-mounting] [--learnt]
//
// The program simulates the draws without lidar and runs methods of kind `rate`. It prints their errors pooled over all
// saturated samples of all draws, coverage and normalised squared error in flight and in contact, and the worst
// saturated segments. The other methods are compared with the first one; if `tumble` is among them, the last part
// compares all methods with `tumble`. FOLDER stores the recordings, so that a second call need not simulate. With
// --exact-mounting the methods receive the true lever arm. With --learnt `tumble` and `tumble_lag` start from the
// calibration that `tumble` learns in another tumble of the same rig. The program is no test: it needs 2 to 3 s of one
// core per draw.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/simulate.hpp"
#include "tests/bench/kept_recording.hpp"
#include "tests/bench/program.hpp"
#include "tests/bench/rate_pool.hpp"
#include "tests/tree.hpp"

namespace {

namespace bench = tumble::bench;
namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;
using bench::RatePool;

struct Request {
  std::string scenario;
  std::uint64_t first = 0, last = 0;
  std::vector<std::string> methods;
  std::filesystem::path keep;
  std::size_t worst = 5;
  bool exact_mounting = false, learnt = false;
};

bool parse(int count, char** words, Request& request) {
  std::vector<std::string> plain;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool option = word == "--method" || word == "--keep" || word == "--worst";
    if (option && i + 1 == count) return false;
    if (word == "--method") {
      request.methods.emplace_back(words[++i]);
    } else if (word == "--keep") {
      request.keep = words[++i];
    } else if (word == "--worst") {
      request.worst = std::strtoull(words[++i], nullptr, 10);
    } else if (word == "--exact-mounting") {
      request.exact_mounting = true;
    } else if (word == "--learnt") {
      request.learnt = true;
    } else {
      plain.push_back(word);
    }
  }
  if (plain.size() != 3) return false;
  request.scenario = plain[0];
  request.first = std::strtoull(plain[1].c_str(), nullptr, 10);
  request.last = std::strtoull(plain[2].c_str(), nullptr, 10);
  if (request.methods.empty()) request.methods = {"raw", "saave", "tumble", "tumble_lag", "oracle"};
  return true;
}

// Returns the recording of seed `seed`; with `other`, the rig of the seed with the motion of another seed.
sim::Recording recording_of(const scenarios::DataRoot& data, const scenarios::Scenario& scenario, std::uint64_t seed,
                            const std::filesystem::path& keep, bool other = false) {
  constexpr std::uint64_t kOther = 1'000'000;
  const std::string name = scenario.name + "_" + std::to_string(seed) + (other ? "_other" : "");
  return bench::kept_recording(data, keep, name, scenario.name, seed, [&] {
    sim::Situation own = scenarios::without_lidars(scenarios::draw(data, scenario, seed));
    if (!other) return own;
    // the far seed is also the device's seed, because the sensing elements are drawn from it
    const sim::Situation far = scenarios::without_lidars(scenarios::draw(data, scenario, seed + kOther));
    own.world = far.world;
    own.motion = far.motion;
    return own;
  });
}

const scenarios::Method& method_of(const std::string& name) {
  return *scenarios::find_methods("rate/" + name).front();
}

// Returns the calibration that the batch smoother estimates from one recording.
scenarios::RigCalibrationUse learn(const sim::Recording& recording) {
  scenarios::RigCalibrationUse learning;
  (void)scenarios::calibrating_method(method_of("tumble"), learning).run(recording.sensors, {}, {});
  learning.given = learning.of_batch;
  return learning;
}

int run(const Request& request) {
  const scenarios::DataRoot data{tumble::test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, request.scenario);
  std::vector<RatePool> pools;
  for (const std::string& name : request.methods) pools.emplace_back(name);
  int rejected = 0;
  for (std::uint64_t seed = request.first; seed <= request.last; ++seed) {
    sim::Recording recording;
    scenarios::RigCalibrationUse given;
    try {
      recording = recording_of(data, scenario, seed, request.keep);
      if (request.learnt) given = learn(recording_of(data, scenario, seed, request.keep, true));
    } catch (const sim::SimulationFailure&) {
      ++rejected;
      continue;
    }
    for (std::size_t i = 0; request.exact_mounting && i < recording.sensors.imus.size(); ++i) {
      recording.sensors.imus[i].T_BI = recording.truth.imus[i].T_BI;
    }
    for (RatePool& pool : pools) {
      scenarios::RigCalibrationUse learning = given;
      const bool learns = request.learnt && pool.name().starts_with("tumble");
      const scenarios::Method method =
          learns ? scenarios::calibrating_method(method_of(pool.name()), learning) : method_of(pool.name());
      const double start_s = scenarios::process_cpu_s();
      const scenarios::Estimate estimate =
          method.run(recording.sensors, {}, {method.info.needs_truth ? &recording.truth : nullptr});
      pool.add(seed, recording, estimate, scenarios::process_cpu_s() - start_s);
    }
  }
  std::printf("%s, draws %llu to %llu, %d rejected\n", scenario.name.c_str(),
              static_cast<unsigned long long>(request.first), static_cast<unsigned long long>(request.last), rejected);
  bench::print_errors(pools);
  bench::print_contact(pools);
  bench::print_honesty(pools);
  bench::print_runs(pools);
  for (const RatePool& pool : pools) {
    if (pool.name().starts_with("tumble")) bench::print_worst(pool, request.worst);
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  return tumble::bench::run_program(count, words,
                                    "rate_statistics SCENARIO|FILE.yaml FIRST LAST [--method NAME]... [--keep FOLDER] "
                                    "[--worst N] [--exact-mounting] [--learnt]",
                                    parse, run);
}
