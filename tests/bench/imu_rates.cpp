// SPDX-License-Identifier: BSD-3-Clause
// imu_rates SCENARIO FIRST LAST KIND/METHOD... [--rate HZ]... [--set NUMBER=VALUE]... [--keep FOLDER] [--draws]
//
// The program simulates the same draws with IMUs of other rates, and with other numbers of a data sheet
// (`gyro_range_rad_s=8.7`). SCENARIO may also be the path of a file, with other devices. Each method and rate has one
// line with these columns: the number of draws with a result; median and mean over the draws of the error (rate: median
// at saturated samples; attitude: inclination; position: at the end; slam: ate_m); both relative to the scenario's own
// rate; the median over the draws of the ratio of a draw's error to its error at that rate, with its 95 % interval
// (BCa, statistics.md (S1) to (S4)); the same median of the oracle of that kind, if the oracle is among the methods,
// which shows the limit of the sensor; the share within three standard deviations (slam: of the draws whose last pose
// lies within the 99.7 % of its NEES), and that of the worst draw; and the CPU time relative to the length of the
// recording. FOLDER stores the recordings (of one set of numbers). --draws also prints a line per draw. The program is
// no test: it needs 2 to 10 s per draw and rate.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/statistics/bootstrap.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/bench/kept_recording.hpp"
#include "tests/bench/program.hpp"
#include "tests/tree.hpp"

namespace {

namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;
using scenarios::Kind;

constexpr double kPoseNees = 20.06 / 6.0;  // 99.73 % quantile of chi-square with six degrees of freedom, per degree

struct Request {
  std::string scenario;
  std::uint64_t first = 0, last = 0;
  std::vector<std::string> methods;
  std::vector<double> rates_hz = {50, 100, 125, 250, 500, 1000, 2000, 4000, 8000};
  std::vector<std::pair<std::string, double>> changes;  ///< changed values of the IMUs whose rate changes
  std::filesystem::path keep;
  bool draws = false;
};

bool parse(int count, char** words, Request& request) {
  std::vector<std::string> plain;
  std::vector<double> rates_hz;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if ((word == "--rate" || word == "--keep" || word == "--set") && i + 1 == count) return false;
    if (word == "--rate") {
      rates_hz.push_back(std::strtod(words[++i], nullptr));
    } else if (word == "--keep") {
      request.keep = words[++i];
    } else if (word == "--draws") {
      request.draws = true;
    } else if (word == "--set") {
      const std::string change = words[++i];
      const std::size_t equals = change.find('=');
      if (equals == std::string::npos) return false;
      char* end = nullptr;
      const double value = std::strtod(change.c_str() + equals + 1, &end);
      if (end == change.c_str() + equals + 1 || *end != '\0') return false;
      request.changes.emplace_back(change.substr(0, equals), value);
    } else {
      plain.push_back(word);
    }
  }
  if (plain.size() < 4) return false;
  request.scenario = plain[0];
  request.first = std::strtoull(plain[1].c_str(), nullptr, 10);
  request.last = std::strtoull(plain[2].c_str(), nullptr, 10);
  request.methods.assign(plain.begin() + 3, plain.end());
  if (!rates_hz.empty()) request.rates_hz = rates_hz;
  return true;
}

/// Returns the simulated run with the rate and numbers of the primary IMU, and of all IMUs of a sphere; 0 keeps the
/// scenario's rate.
scenarios::SimulatedDraw draw_of(const scenarios::DataRoot& data, const Request& request, std::uint64_t seed,
                                 double rate_hz, bool lidar) {
  scenarios::SimulatedDraw draw;
  draw.scenario = request.scenario;
  draw.seed = seed;
  const std::string name = request.scenario + "_" + std::to_string(seed) + "_" +
                           std::to_string(static_cast<int>(rate_hz)) + (lidar ? "_lidar" : "");
  const auto situation = [&] {
    const sim::ResolvedSituation drawn = scenarios::draw(data, scenarios::load_scenario(data, request.scenario), seed);
    sim::Situation out = lidar ? drawn : scenarios::without_lidars(drawn);
    for (sim::SensorSpec& sensor : out.sensors) {
      const bool one_of_them = &sensor == &out.sensors.front() || out.robot.type == "sphere";
      if (sensor.kind != "imu" || !one_of_them) continue;
      for (const auto& [number, value] : request.changes) sensor.values.set(number, value);
      if (rate_hz > 0.0) sensor.values.set("output_rate_hz", rate_hz);
    }
    return out;
  };
  draw.recording = tumble::bench::kept_recording(data, request.keep, name, request.scenario, seed, situation);
  return draw;
}

struct Metrics {
  const char *error, *coverage;
};

Metrics metrics_of(Kind kind) {
  if (kind == Kind::rate) return {"rate_error_clipped_median_rad_s", "rate_coverage_3sigma"};
  if (kind == Kind::attitude) return {"inclination_rmse_rad", "inclination_coverage_3sigma"};
  if (kind == Kind::position) return {"position_end_error_m", "position_coverage_3sigma"};
  return {"ate_m", "pose_nees"};
}

/// Pool contains the results of one method at one rate, over the simulated runs.
struct Pool {
  std::map<std::uint64_t, double> error_of;  ///< by seed, for draws with an error
  std::vector<double> coverage;
  double cpu_s = 0.0, length_s = 0.0;
  int failed = 0;
};

std::vector<double> errors(const Pool& pool) {
  std::vector<double> out;
  for (const auto& [seed, error] : pool.error_of) out.push_back(error);
  return out;
}

/// Returns the median ratio, with its interval, of the errors at both rates, over the runs that have an error at both.
scenarios::Interval paired(const Pool& pool, const Pool& own) {
  std::vector<double> ratios;
  for (const auto& [seed, error] : pool.error_of) {
    const auto other = own.error_of.find(seed);
    if (other != own.error_of.end() && other->second > 0.0) ratios.push_back(error / other->second);
  }
  if (ratios.empty()) return {std::nan(""), std::nan(""), std::nan("")};
  return scenarios::MedianBootstrap(ratios.size()).interval(ratios);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
}

void add(const scenarios::Method& method, const scenarios::SimulatedDraw& draw, bool draws, Pool& pool) {
  scenarios::Outcome outcome;
  const double start_s = scenarios::process_cpu_s();
  const scenarios::Estimate estimate = scenarios::run_method(method, draw, outcome);
  pool.cpu_s += scenarios::process_cpu_s() - start_s;
  const auto& stamps = draw.recording.sensors.imus.front().time_ns;
  pool.length_s += 1e-9 * static_cast<double>(stamps.back() - stamps.front());
  if (outcome.status == scenarios::OutcomeStatus::ok) scenarios::assess(method, draw, nullptr, estimate, outcome);
  if (outcome.status != scenarios::OutcomeStatus::ok) {
    ++pool.failed;
    return;
  }
  const Metrics metrics = metrics_of(method.info.kind);
  for (const scenarios::Score& score : outcome.scores) {
    if (std::isnan(score.value)) continue;
    if (score.metric == metrics.error) pool.error_of[draw.seed] = score.value;
    if (score.metric != metrics.coverage) continue;
    const bool nees = method.info.kind == Kind::slam;
    pool.coverage.push_back(nees ? static_cast<double>(score.value <= kPoseNees) : score.value);
  }
  if (!draws) return;
  std::printf("  %s draw %llu:", method.info.name.c_str(), static_cast<unsigned long long>(draw.seed));
  for (const scenarios::Score& score : outcome.scores) {
    if (score.metric == metrics.error || score.metric == metrics.coverage) std::printf(" %.5f", score.value);
  }
  std::printf("\n");
}

/// `oracle` is the oracle's median of pairs, or NaN.
void print(const std::string& name, double rate_hz, const Pool& pool, const Pool& own, double oracle) {
  const std::vector<double> error = errors(pool), own_error = errors(own);
  const double median = scenarios::quantile(error, 0.5);
  const scenarios::Interval pairs = paired(pool, own);
  std::printf("%-22s %6.0f %3zu %9.5f %9.5f %7.2f %7.2f  %5.2f (%4.2f to %4.2f) %6.2f %8.2f %7.2f %7.2f", name.c_str(),
              rate_hz, error.size(), median, mean(error), median / scenarios::quantile(own_error, 0.5),
              mean(error) / mean(own_error), pairs.value, pairs.low, pairs.high, oracle, 100.0 * mean(pool.coverage),
              100.0 * scenarios::quantile(pool.coverage, 0.0), pool.cpu_s / pool.length_s);
  if (pool.failed > 0) std::printf("  not ok: %d", pool.failed);
  std::printf("\n");
  std::fflush(stdout);
}

int run(const Request& request) {
  const scenarios::DataRoot data{tumble::test::source_dir()};
  std::vector<scenarios::MethodPointer> methods;
  for (const std::string& name : request.methods) methods.push_back(scenarios::find_methods(name).at(0));
  const bool lidar =
      std::any_of(methods.begin(), methods.end(), [](const auto& method) { return method->info.kind == Kind::slam; });
  std::printf("%s, draws %llu to %llu; 0 Hz: as the scenario has it\n", request.scenario.c_str(),
              static_cast<unsigned long long>(request.first), static_cast<unsigned long long>(request.last));
  std::printf("%-22s %6s %3s %9s %9s %7s %7s  %-20s %6s %8s %7s %7s\n", "method", "Hz", "n", "median", "mean",
              "against", "against", "pairs", "oracle", "within", "worst", "cpu");
  std::vector<Pool> own(methods.size());
  std::vector<double> rates_hz = {0.0};
  rates_hz.insert(rates_hz.end(), request.rates_hz.begin(), request.rates_hz.end());
  for (const double rate_hz : rates_hz) {
    std::vector<Pool> pools(methods.size());
    tumble::bench::for_each_draw(request.first, request.last, [&](std::uint64_t seed) {
      const scenarios::SimulatedDraw draw = draw_of(data, request, seed, rate_hz, lidar);
      for (std::size_t m = 0; m < methods.size(); ++m) add(*methods[m], draw, request.draws, pools[m]);
    });
    if (rate_hz == 0.0) own = pools;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      double oracle = std::nan("");
      for (std::size_t o = 0; o < methods.size(); ++o) {
        if (methods[o]->info.kind != methods[m]->info.kind || methods[o]->info.name != "oracle") continue;
        oracle = paired(pools[o], own[o]).value;
      }
      print(request.methods[m], rate_hz, pools[m], own[m], oracle);
    }
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  return tumble::bench::run_program(
      count, words,
      "imu_rates SCENARIO FIRST LAST KIND/METHOD... [--rate HZ]... [--set NUMBER=VALUE]... [--keep FOLDER] [--draws]",
      parse, run);
}
