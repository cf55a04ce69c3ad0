// SPDX-License-Identifier: BSD-3-Clause
// simulation_cost SCENARIO FIRST LAST
//
// The program measures the processor time (user and system) of building and simulating a draw without its lidars and
// with them, and prints a line per draw and the medians. Equal digests show that two builds simulated the same bits.
// The program uses one thread.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/tree.hpp"

namespace {

using namespace tumble;  // NOLINT: a program of its own

int run(const std::string& name, std::uint64_t first, std::uint64_t last) {
  const scenarios::DataRoot data{test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, name);
  std::vector<double> bare_s, whole_s;
  std::printf("%6s %9s %9s  %-32s  %s\n", "seed", "no lidar", "lidar", "digest without lidar", "with");
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const auto bare = scenarios::simulate_draw(data, scenario, seed, 1, scenarios::Lidars::left_out);
    const auto whole = scenarios::simulate_draw(data, scenario, seed, 1);
    bare_s.push_back(bare.simulate_cpu_s);
    whole_s.push_back(whole.simulate_cpu_s);
    std::printf("%6llu %7.3f s %7.3f s  %s  %s\n", static_cast<unsigned long long>(seed), bare_s.back(), whole_s.back(),
                bare.recording_digest.c_str(), whole.recording_digest.c_str());
    std::fflush(stdout);
  }
  if (bare_s.empty()) return 1;
  std::printf("%6s %7.3f s %7.3f s\n", "median", scenarios::quantile(bare_s, 0.5), scenarios::quantile(whole_s, 0.5));
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::fprintf(stderr, "usage: simulation_cost SCENARIO FIRST LAST\n");
    return 2;
  }
  try {
    return run(words[1], std::strtoull(words[2], nullptr, 10), std::strtoull(words[3], nullptr, 10));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
