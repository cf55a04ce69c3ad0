// SPDX-License-Identifier: BSD-3-Clause
// attitude_statistics SCENARIO|RECORDING.h5 FIRST LAST [--method NAME]... [--set M.NAME=VALUE]... [--keep FOLDER]
// [--each]
//
// The program simulates the draws without lidar (or reads one recording) and runs methods of kind `attitude`. For each
// method it prints results over the draws whose gyro is never saturated, over the draws with saturation and over all
// draws: median and mean of the rms error in motion of the inclination and of the whole attitude, and the share of
// draws that are better than with the first method. For methods that report a covariance, it also prints the mean
// normalised square of the tilt error per degree of freedom in motion. The shares of samples within one and within
// three standard deviations follow (a normal distribution in two dimensions has 39.3 % and 98.9 %). FOLDER stores the
// recordings. The program is no test: it needs 2 to 3 s of one core per draw.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "tests/bench/kept_recording.hpp"
#include "tests/bench/program.hpp"
#include "tests/tree.hpp"

namespace {

namespace bench = tumble::bench;
namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;

struct Request {
  std::string scenario;
  std::uint64_t first = 0, last = 0;
  std::vector<std::string> methods;
  std::map<std::string, sim::Values> values;  ///< by method
  std::filesystem::path keep;
  bool each = false;
};

bool parse_value(const std::string& word, Request& request) {
  const std::size_t dot = word.find('.'), equals = word.find('=');
  if (dot == std::string::npos || equals == std::string::npos || equals < dot) return false;
  request.values[word.substr(0, dot)].set(word.substr(dot + 1, equals - dot - 1),
                                          std::strtod(word.c_str() + equals + 1, nullptr));
  return true;
}

bool parse(int count, char** words, Request& request) {
  std::vector<std::string> plain;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool option = word == "--method" || word == "--set" || word == "--keep";
    if (option && i + 1 == count) return false;
    if (word == "--method") {
      request.methods.emplace_back(words[++i]);
    } else if (word == "--set") {
      if (!parse_value(words[++i], request)) return false;
    } else if (word == "--keep") {
      request.keep = words[++i];
    } else if (word == "--each") {
      request.each = true;
    } else {
      plain.push_back(word);
    }
  }
  if (plain.size() != 3) return false;
  request.scenario = plain[0];
  request.first = std::strtoull(plain[1].c_str(), nullptr, 10);
  request.last = std::strtoull(plain[2].c_str(), nullptr, 10);
  if (request.methods.empty()) request.methods = {"integrate", "madgwick", "vqf", "tumble"};
  return true;
}

/// Run contains the results of one method on one simulated run.
struct Run {
  double inclination_rad = std::numeric_limits<double>::infinity();
  double attitude_rad = std::numeric_limits<double>::infinity();
  bool clips = false;
};

/// Statistics of all draws.
struct Pool {
  std::string name;
  std::vector<Run> runs;
  double nees = 0.0;
  int samples = 0, within_one = 0, within_three = 0;
};

void add_consistency(const scenarios::Estimate& estimate, const sim::Truth& truth, Pool& pool) {
  const scenarios::TruthTrack track(truth, estimate.frame);
  for (const tumble::AttitudeState& attitude : estimate.attitudes) {
    const Eigen::Matrix2d covariance = attitude.covariance_rad2.topLeftCorner<2, 2>();
    if (!track.covers_attitude(attitude.time_ns) || track.at_rest(attitude.time_ns) || !(covariance.trace() > 0.0)) {
      continue;
    }
    const Eigen::Vector2d error =
        scenarios::tilt_error_rad(attitude.orientation_W, track.pose(attitude.time_ns).orientation_W);
    const double square = error.dot(covariance.inverse() * error);
    pool.nees += 0.5 * square;
    ++pool.samples;
    pool.within_one += square <= 1.0 ? 1 : 0;
    pool.within_three += square <= 9.0 ? 1 : 0;
  }
}

bool clips(const sim::Recording& recording) {
  const scenarios::ClippingTruth truth(recording.sensors, recording.truth);
  const auto& stamps = recording.sensors.imus.front().time_ns;
  return std::any_of(stamps.begin(), stamps.end(), [&](std::int64_t time_ns) {
    const auto sample = truth.at(time_ns);
    return sample && sample->clipped_axes != 0;
  });
}

void add(const sim::Recording& recording, const Request& request, Pool& pool) {
  const scenarios::Method& method = *scenarios::find_methods("attitude/" + pool.name).front();
  const auto given = request.values.find(pool.name);
  const sim::Values values = given == request.values.end() ? sim::Values{} : given->second;
  const scenarios::Estimate estimate =
      method.run(recording.sensors, values, {method.info.needs_truth ? &recording.truth : nullptr});
  Run run;
  run.clips = clips(recording);
  if (estimate.status.ok()) {
    for (const auto& [metric, value] :
         scenarios::score(scenarios::Kind::attitude, estimate, {&recording.sensors, &recording.truth, nullptr})) {
      if (metric == "inclination_rmse_rad") run.inclination_rad = value;
      if (metric == "attitude_rmse_rad") run.attitude_rad = value;
    }
    add_consistency(estimate, recording.truth, pool);
  }
  pool.runs.push_back(run);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

template <typename Which>
void print_part(const char* part, const std::vector<Pool>& pools, const Which& which) {
  const auto wanted = [&](const Run& run) { return which(run); };
  const auto draws = std::count_if(pools.front().runs.begin(), pools.front().runs.end(), wanted);
  if (draws == 0) return;
  std::printf("%s, %td draws: rms in motion [rad]\n%-14s %12s %12s %12s %12s %10s\n", part, draws, "method",
              "incl. median", "mean", "att. median", "mean", "better in");
  for (const Pool& pool : pools) {
    std::vector<double> inclination, attitude;
    int better = 0;
    for (std::size_t k = 0; k < pool.runs.size(); ++k) {
      if (!which(pool.runs[k])) continue;
      inclination.push_back(pool.runs[k].inclination_rad);
      attitude.push_back(pool.runs[k].attitude_rad);
      better += pool.runs[k].inclination_rad < pools.front().runs[k].inclination_rad ? 1 : 0;
    }
    std::printf("%-14s %12.4f %12.4f %12.4f %12.4f %10d\n", pool.name.c_str(), scenarios::quantile(inclination, 0.5),
                mean(inclination), scenarios::quantile(attitude, 0.5), mean(attitude), better);
  }
}

void print_consistency(const std::vector<Pool>& pools) {
  for (const Pool& pool : pools) {
    if (pool.samples == 0) continue;
    const double n = pool.samples;
    std::printf("%-14s tilt: nees per degree %.2f, within one deviation %.1f %% (39.3), three %.1f %% (98.9)\n",
                pool.name.c_str(), pool.nees / n, 100.0 * pool.within_one / n, 100.0 * pool.within_three / n);
  }
}

void print_each(std::uint64_t seed, const std::vector<Pool>& pools) {
  std::printf("%llu %s", static_cast<unsigned long long>(seed), pools.front().runs.back().clips ? "clips" : "free ");
  for (const Pool& pool : pools) {
    std::printf("  %s %.4f/%.4f", pool.name.c_str(), pool.runs.back().inclination_rad, pool.runs.back().attitude_rad);
  }
  std::printf("\n");
}

sim::Recording recording_of(const scenarios::DataRoot& data, const Request& request, std::uint64_t seed) {
  if (request.scenario.ends_with(".h5")) {
    return {scenarios::read_sensors(request.scenario), scenarios::read_truth(request.scenario)};
  }
  const scenarios::Scenario scenario = scenarios::load_scenario(data, request.scenario);
  return bench::kept_recording(
      data, request.keep, scenario.name + "_" + std::to_string(seed), scenario.name, seed,
      [&] { return sim::Situation(scenarios::without_lidars(scenarios::draw(data, scenario, seed))); });
}

int run(const Request& request) {
  const scenarios::DataRoot data{tumble::test::source_dir()};
  std::vector<Pool> pools;
  for (const std::string& name : request.methods) pools.push_back({.name = name, .runs = {}});
  bench::for_each_draw(request.first, request.last, [&](std::uint64_t seed) {
    const sim::Recording recording = recording_of(data, request, seed);
    for (Pool& pool : pools) add(recording, request, pool);
    if (request.each) print_each(seed, pools);
  });
  print_part("never clips", pools, [](const Run& one) { return !one.clips; });
  print_part("clips", pools, [](const Run& one) { return one.clips; });
  print_part("all", pools, [](const Run&) { return true; });
  print_consistency(pools);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  return bench::run_program(count, words,
                            "attitude_statistics SCENARIO|RECORDING.h5 FIRST LAST [--method NAME]... "
                            "[--set M.NAME=VALUE]... [--keep FOLDER] [--each]",
                            parse, run);
}
