// SPDX-License-Identifier: BSD-3-Clause
// motion_distribution SCENARIO FIRST LAST
//
// The program simulates the draws without lidar and prints a line per draw and their distributions, for comparison with
// the published campaign. The program is no test, because it takes minutes.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/scoring/motion_summary.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/simulate.hpp"
#include "tests/tree.hpp"

namespace {

using tumble::scenarios::MotionSummary;

struct Spread {
  std::vector<MotionSummary> draws;
  std::vector<double> cpu_s;
  std::map<std::string, int> touching;  ///< number of draws that touch a kind of surface
  int rejected = 0;
};

/// Returns the kinds of the touched surfaces: their names without the number.
std::set<std::string> touched(const tumble::sim::Truth& truth) {
  std::set<std::string> kinds;
  for (const tumble::sim::ContactTruth& contact : truth.contacts) {
    if (contact.surface_id < 0) continue;
    const std::string& name = truth.surfaces[static_cast<std::size_t>(contact.surface_id)];
    kinds.insert(name.substr(0, name.find('_')));
  }
  return kinds;
}

void print_quantiles(const char* what, std::vector<double> values) {
  std::printf("%-34s", what);
  for (const double share : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0})
    std::printf(" %8.3g", tumble::scenarios::quantile(values, share));
  std::printf("\n");
}

template <typename Get>
std::vector<double> column(const Spread& spread, Get get) {
  std::vector<double> values;
  for (const MotionSummary& draw : spread.draws) values.push_back(static_cast<double>(get(draw)));
  return values;
}

void print(const Spread& spread) {
  const double count = static_cast<double>(spread.draws.size());
  double clipping = 0, samples = 0, clipped = 0, several = 0, accel = 0;
  for (const MotionSummary& draw : spread.draws) {
    clipping += draw.clipped_samples > 0 ? 1 : 0;
    samples += static_cast<double>(draw.samples);
    clipped += static_cast<double>(draw.clipped_samples);
    several += static_cast<double>(draw.several_axes_samples);
    accel += static_cast<double>(draw.accel_clipped_samples);
  }
  std::printf("%zu draws, %d rejected\n", spread.draws.size(), spread.rejected);
  if (spread.draws.empty()) return;
  std::printf("tumbles that clip the gyro         %8.3g\n", clipping / count);
  std::printf("clipped share of moving samples    %8.3g\n", clipped / std::max(1.0, samples));
  std::printf("two axes or more, of clipped       %8.3g\n", several / std::max(1.0, clipped));
  std::printf("accelerometer clipped, of moving   %8.3g\n", accel / std::max(1.0, samples));
  for (const auto& [kind, draws] : spread.touching) std::printf("touch %-28s %8.3g\n", kind.c_str(), draws / count);
  std::printf("%-34s %8s %8s %8s %8s %8s %8s %8s\n", "", "min", "5 %", "25 %", "median", "75 %", "95 %", "max");
  print_quantiles("peak rate, rad/s", column(spread, [](const MotionSummary& m) { return m.peak_rate_rad_s; }));
  print_quantiles("peak acceleration, m/s^2", column(spread, [](const MotionSummary& m) { return m.peak_accel_m_s2; }));
  print_quantiles("path, m", column(spread, [](const MotionSummary& m) { return m.path_m; }));
  print_quantiles("moving, s", column(spread, [](const MotionSummary& m) { return m.moving_s; }));
  print_quantiles("rest at the end, s", column(spread, [](const MotionSummary& m) { return m.rest_at_end_s; }));
  print_quantiles("flight share", column(spread, [](const MotionSummary& m) { return m.flight_share; }));
  print_quantiles("impacts", column(spread, [](const MotionSummary& m) { return m.impacts; }));
  print_quantiles("simulation, s of one core", spread.cpu_s);
}

void print(std::uint64_t seed, const MotionSummary& m) {
  std::printf("%llu  %5.2f rad/s  %4zu clipped (%3zu %3zu %3zu)  %4zu several  ", static_cast<unsigned long long>(seed),
              m.peak_rate_rad_s, m.clipped_samples, m.axis_clipped_samples[0], m.axis_clipped_samples[1],
              m.axis_clipped_samples[2], m.several_axes_samples);
  std::printf("%6.1f m/s^2  %5.2f m  %4.1f s  flight %.2f  rest %.1f s\n", m.peak_accel_m_s2, m.path_m, m.moving_s,
              m.flight_share, m.rest_at_end_s);
}

int run(int count, char** words) {
  using namespace tumble;
  if (count != 4) {
    std::fprintf(stderr, "usage: motion_distribution SCENARIO|FILE.yaml FIRST LAST\n");
    return 2;
  }
  const scenarios::DataRoot data{tumble::test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, words[1]);
  const std::uint64_t first = std::strtoull(words[2], nullptr, 10), last = std::strtoull(words[3], nullptr, 10);
  Spread spread;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    try {
      const sim::ResolvedSituation situation = scenarios::without_lidars(scenarios::draw(data, scenario, seed));
      const double start_s = scenarios::process_cpu_s();
      const sim::Recording recording = sim::simulate(sim::BuiltSituation(situation, data.models()));
      spread.cpu_s.push_back(scenarios::process_cpu_s() - start_s);
      const MotionSummary m = scenarios::summarise_motion(recording.sensors, recording.truth);
      spread.draws.push_back(m);
      for (const std::string& kind : touched(recording.truth)) ++spread.touching[kind];
      print(seed, m);
    } catch (const sim::SimulationFailure& failure) {
      ++spread.rejected;
      std::printf("%llu  rejected: %s\n", static_cast<unsigned long long>(seed), failure.what());
    }
    std::fflush(stdout);
  }
  print(spread);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  try {
    return run(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
