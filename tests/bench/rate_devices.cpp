// SPDX-License-Identifier: BSD-3-Clause
// rate_devices FIRST LAST [--method NAME]... [--keep FOLDER] [--row N] [--draws] [--ablation] [--learnt]
//
// The program tests errors of real devices besides saturation, one row each, on the same draws of `hill` without lidar:
// a late accelerometer, a gyro window that is too long, a low-pass, scale errors, g-sensitivity, repeated readings, and
// all of them together (`hill_consumer`). For each method of kind `rate` it prints the error at saturated samples, its
// ratio to the first row, the share of saturated axes within three reported standard deviations (all draws, the worst
// draw), and their mean squared error over variance. It also prints the share of elements that the method reports as
// saturated, among elements that lost more than 0.1 rad/s, and the share of reported elements that lost anything.
// FOLDER stores the recordings. --draws also prints a line per draw. --ablation uses `hill_consumer` with one of its
// errors switched off at a time instead. With --learnt, only methods that learn run, from the calibration learnt in
// another tumble of the same rig and device. The program is no test: it needs 2 to 3 s of one core per draw and row.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/bench/kept_recording.hpp"
#include "tests/bench/program.hpp"
#include "tests/bench/rate_pool.hpp"
#include "tests/tree.hpp"

namespace {

namespace bench = tumble::bench;
namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;
using bench::RatePool;

struct Row {
  std::string title, scenario;
  std::vector<std::pair<std::string, double>> changes;  ///< changed values of the primary IMU
};

const std::vector<Row>& rows() {
  static const std::vector<Row> kRows = {
      {"as it is", "hill", {}},
      {"accelerometer 10 ms late", "hill", {{"accel_delay_s", 0.01}}},
      {"gyro window 20 ms", "hill", {{"gyro_window_s", 0.02}}},
      {"accelerometer low-passed 20 Hz", "hill", {{"accel_bandwidth_hz", 20.0}}},
      {"scale errors of 1 %", "hill", {{"gyro_scale_error", 0.01}, {"accel_scale_error", 0.01}}},
      {"g-sensitivity 0.1 deg/s/g", "hill", {{"gyro_g_sensitivity_spread_s_m", 1.7797e-4}}},
      {"gyro repeats, 62.5 Hz", "hill", {{"gyro_update_hz", 62.5}}},
      {"accelerometer repeats, 50 Hz", "hill", {{"accel_update_hz", 50.0}}},
      {"hill_consumer", "hill_consumer", {}},
  };
  return kRows;
}

// Returns `hill_consumer` with one of its errors switched off at a time.
const std::vector<Row>& ablations() {
  using Changes = std::vector<std::pair<std::string, double>>;
  static const Changes kScale = {{"gyro_scale_error", 0.0}, {"accel_scale_error", 0.0}};
  static const Changes kAcross = {{"gyro_misalignment_rad", 0.0}, {"accel_misalignment_rad", 0.0}};
  static const Changes kDelays = {{"gyro_delay_s", 0.0}, {"accel_delay_s", 0.0}};
  static const Changes kWindows = {{"gyro_window_s", 0.0}, {"accel_window_s", 0.0}, {"digital_bandwidth_hz", 0.0}};
  static const Changes kRepeats = {{"gyro_update_hz", 0.0}, {"accel_update_hz", 0.0}};
  static const Changes kElements = {{"gyro_element_misalignment", 0.0}, {"gyro_element_scale", 0.0},
                                    {"gyro_element_offset_rad_s", 0.0}, {"accel_element_misalignment", 0.0},
                                    {"accel_element_scale", 0.0},       {"accel_element_offset_m_s2", 0.0}};
  const auto joined = [](std::initializer_list<Changes> parts) {
    Changes out;
    for (const Changes& part : parts) out.insert(out.end(), part.begin(), part.end());
    return out;
  };
  static const std::vector<Row> kRows = {
      {"as it is", "hill", {}},
      {"hill_consumer", "hill_consumer", {}},
      {"without scale", "hill_consumer", kScale},
      {"without misalignment", "hill_consumer", kAcross},
      {"without g-sensitivity", "hill_consumer", {{"gyro_g_sensitivity_spread_s_m", 0.0}}},
      {"without delays", "hill_consumer", kDelays},
      {"without windows, low-pass", "hill_consumer", kWindows},
      {"without repeats", "hill_consumer", kRepeats},
      {"without jitter of the stamps", "hill_consumer", {{"time_jitter_s", 0.0}}},
      {"without tilted elements", "hill_consumer", kElements},
      {"without delays, windows, repeats", "hill_consumer", joined({kDelays, kWindows, kRepeats})},
      {"without any of these", "hill_consumer",
       joined({kScale,
               kAcross,
               kDelays,
               kWindows,
               kRepeats,
               kElements,
               {{"gyro_g_sensitivity_spread_s_m", 0.0}, {"time_jitter_s", 0.0}}})},
  };
  return kRows;
}

struct Request {
  std::uint64_t first = 0, last = 0;
  std::vector<std::string> methods;
  std::filesystem::path keep;
  int row = -1;
  bool draws = false, ablation = false, learnt = false;

  const std::vector<Row>& table() const { return ablation ? ablations() : rows(); }
};

bool parse(int count, char** words, Request& request) {
  std::vector<std::string> plain;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool option = word == "--method" || word == "--keep" || word == "--row";
    if (option && i + 1 == count) return false;
    if (word == "--draws") {
      request.draws = true;
      continue;
    }
    if (word == "--learnt") {
      request.learnt = true;
      continue;
    }
    if (word == "--ablation") {
      request.ablation = true;
      continue;
    }
    if (word == "--method") {
      request.methods.emplace_back(words[++i]);
    } else if (word == "--keep") {
      request.keep = words[++i];
    } else if (word == "--row") {
      request.row = std::atoi(words[++i]);
    } else {
      plain.push_back(word);
    }
  }
  if (plain.size() != 2) return false;
  request.first = std::strtoull(plain[0].c_str(), nullptr, 10);
  request.last = std::strtoull(plain[1].c_str(), nullptr, 10);
  if (request.methods.empty()) request.methods = {"raw", "tumble", "oracle"};
  return true;
}

// Returns the recording of seed `seed`; with `other`, the rig and device of the seed with the motion of another seed.
sim::Recording recording_of(const scenarios::DataRoot& data, const Row& row, std::size_t index, std::uint64_t seed,
                            const std::string& prefix, const std::filesystem::path& keep, bool other = false) {
  constexpr std::uint64_t kOther = 1'000'000;
  const std::string name = prefix + std::to_string(index) + "_" + std::to_string(seed) + (other ? "_other" : "");
  return tumble::bench::kept_recording(data, keep, name, row.scenario, seed, [&] {
    const scenarios::Scenario scenario = scenarios::load_scenario(data, row.scenario);
    sim::Situation out = scenarios::without_lidars(scenarios::draw(data, scenario, seed));
    if (other) {
      const sim::Situation far = scenarios::without_lidars(scenarios::draw(data, scenario, seed + kOther));
      out.world = far.world;
      out.motion = far.motion;
    }
    for (const auto& [parameter, value] : row.changes) out.sensors.front().values.set(parameter, value);
    return out;
  });
}

std::vector<double> normalised(const RatePool& pool) {
  std::vector<double> out(pool.normalised_flight().begin(), pool.normalised_flight().end());
  out.insert(out.end(), pool.normalised_contact().begin(), pool.normalised_contact().end());
  return out;
}

double within(const std::vector<double>& normalised, std::size_t first = 0) {
  if (normalised.size() == first) return 1.0;
  const auto begin = normalised.begin() + static_cast<std::ptrdiff_t>(first);
  const auto count = std::count_if(begin, normalised.end(), [](double z) { return z <= 9.0; });
  return static_cast<double>(count) / static_cast<double>(normalised.size() - first);
}

// Rails contains the elements at their saturation level, according to the truth and to a method.
struct Rails {
  static constexpr double kDeep_rad_s = 0.1;
  double deep = 0.0, found = 0.0, called = 0.0, right = 0.0;

  void add(const sim::Recording& recording, const scenarios::Estimate& estimate) {
    const sim::ImuRecord& imu = recording.sensors.imus.front();
    const sim::ImuTruth& truth = recording.truth.imus.front();
    const double period_s = 1e-9 * static_cast<double>(imu.period_ns);
    const double noise = std::max(1e-6, imu.gyro_noise_rad_s_sqrt_hz / std::sqrt(period_s));
    for (std::size_t k = 0; k < std::min(estimate.rates.size(), imu.time_ns.size()); ++k) {
      const Eigen::Vector3d lost = truth.gyro_unclipped_rad_s[k] - imu.gyro_rad_s[k];
      for (std::size_t j = 0; j < 3; ++j) {
        const auto axis = static_cast<Eigen::Index>(j);
        const double own = std::abs(truth.gyro_elements.empty() ? lost[axis] : truth.gyro_elements[j].dot(lost));
        const bool said = (estimate.rates[k].clipped_axes >> j & 1u) != 0;
        deep += own > kDeep_rad_s;
        found += own > kDeep_rad_s && said;
        called += said;
        right += said && own > noise;
      }
    }
  }
  void add(const Rails& other) {
    deep += other.deep, found += other.found, called += other.called, right += other.right;
  }
  double found_share() const { return deep > 0.0 ? found / deep : 1.0; }
  double right_share() const { return called > 0.0 ? right / called : 1.0; }
};

// Figures contains the results of one method over all simulated runs of a row.
struct Figures {
  double median = 0.0, p99 = 0.0, free = 0.0, share = 0.0, worst = 1.0, nees = 0.0, us = 0.0;
  Rails rails;
};

// Returns a method's estimate of a run; `other` is the recording from which it calibrates first, or null.
scenarios::Estimate estimate_of(const scenarios::Method& method, const sim::Recording& recording,
                                const sim::Recording* other) {
  if (other == nullptr)
    return method.run(recording.sensors, {}, {method.info.needs_truth ? &recording.truth : nullptr});
  scenarios::RigCalibrationUse before, learning;
  (void)scenarios::calibrating_method(method, before).run(other->sensors, {}, {});
  if (before.found() != nullptr) learning.given = *before.found();
  return scenarios::calibrating_method(method, learning).run(recording.sensors, {}, {});
}

Figures figures(const Request& request, const std::vector<sim::Recording>& recordings,
                const std::vector<sim::Recording>& others, const std::string& name) {
  RatePool pool(name);
  Figures out;
  const scenarios::Method& method = *scenarios::find_methods("rate/" + name).front();
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const sim::Recording& recording = recordings[i];
    const double start_s = scenarios::process_cpu_s();
    const bool learns = request.learnt && method.info.calibrates_rig;
    const scenarios::Estimate estimate = estimate_of(method, recording, learns ? &others[i] : nullptr);
    const std::size_t flights = pool.normalised_flight().size(), contacts = pool.normalised_contact().size();
    const std::size_t before = pool.clipped_rad_s().size();
    pool.add(request.first + i, recording, estimate, scenarios::process_cpu_s() - start_s);
    std::vector<double> own(pool.normalised_flight().begin() + static_cast<std::ptrdiff_t>(flights),
                            pool.normalised_flight().end());
    own.insert(own.end(), pool.normalised_contact().begin() + static_cast<std::ptrdiff_t>(contacts),
               pool.normalised_contact().end());
    out.worst = std::min(out.worst, within(own));
    Rails rails;
    rails.add(recording, estimate);
    out.rails.add(rails);
    if (!request.draws) continue;
    const std::vector<double> errors(pool.clipped_rad_s().begin() + static_cast<std::ptrdiff_t>(before),
                                     pool.clipped_rad_s().end());
    const auto health = [&](const char* value) {
      const auto at = estimate.health.find(value);
      return at == estimate.health.end() ? 0.0 : at->second;
    };
    std::printf("  draw %llu %s: %zu clipped, median %.4f, p90 %.3f, within %.1f, found %.1f of %.0f, right %.1f;",
                static_cast<unsigned long long>(request.first + i), name.c_str(), errors.size(),
                scenarios::quantile(errors, 0.5), scenarios::quantile(errors, 0.9), 100.0 * within(own),
                100.0 * rails.found_share(), rails.deep, 100.0 * rails.right_share());
    std::printf(" delay %.2f ms, rounds %.0f, mahalanobis %.1f, held %.0f, calibrated %.2f, together %.2f\n",
                1e3 * health("accel_delay_s"), health("error_rounds"), health("calibration_mahalanobis"),
                health("calibration_at_prior"), health("device_calibrated"), health("triads_together"));
  }
  const std::vector<double> all = normalised(pool);
  out.median = scenarios::quantile(pool.clipped_rad_s(), 0.5);
  out.p99 = scenarios::quantile(pool.clipped_rad_s(), 0.99);
  out.free = scenarios::quantile(pool.free_rad_s(), 0.5);
  out.share = within(all);
  for (const double z : all) out.nees += z / static_cast<double>(all.size());
  out.us = pool.cpu_us_per_sample();
  return out;
}

int run(const Request& request) {
  const scenarios::DataRoot data{tumble::test::source_dir()};
  std::printf("draws %llu to %llu; errors at clipped samples [rad/s], within 3 sigma [%%]\n",
              static_cast<unsigned long long>(request.first), static_cast<unsigned long long>(request.last));
  std::printf("%-31s %-12s %8s %7s %8s %8s %7s %7s %8s %7s %6s %6s\n", "device", "method", "median", "against", "p99",
              "free", "within", "worst", "z^2", "us", "found", "right");
  std::vector<double> as_it_is(request.methods.size(), 0.0);
  const std::vector<Row>& table = request.table();
  for (std::size_t r = 0; r < table.size(); ++r) {
    if (request.row >= 0 && r != 0 && r != static_cast<std::size_t>(request.row)) continue;
    std::vector<sim::Recording> recordings, others;
    const std::string prefix = request.ablation ? "ablation" : "row";
    bench::for_each_draw(request.first, request.last, [&](std::uint64_t seed) {
      sim::Recording own = recording_of(data, table[r], r, seed, prefix, request.keep);
      if (request.learnt) others.push_back(recording_of(data, table[r], r, seed, prefix, request.keep, true));
      recordings.push_back(std::move(own));
    });
    for (std::size_t m = 0; m < request.methods.size(); ++m) {
      const Figures f = figures(request, recordings, others, request.methods[m]);
      if (r == 0) as_it_is[m] = f.median;
      std::printf("%-31s %-12s %8.4f %6.2fx %8.3f %8.4f %7.2f %7.2f %8.2f %7.2f %6.2f %6.2f\n", table[r].title.c_str(),
                  request.methods[m].c_str(), f.median, f.median / as_it_is[m], f.p99, f.free, 100.0 * f.share,
                  100.0 * f.worst, f.nees, f.us, 100.0 * f.rails.found_share(), 100.0 * f.rails.right_share());
    }
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  return tumble::bench::run_program(
      count, words,
      "rate_devices FIRST LAST [--method NAME]... [--keep FOLDER] [--row N] [--draws] [--ablation] [--learnt]", parse,
      run);
}
