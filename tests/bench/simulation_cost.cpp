// SPDX-License-Identifier: BSD-3-Clause
// simulation_cost SCENARIO FIRST LAST: measures the processor time (user and system) to build and simulate a draw,
// without its lidars and with them. Prints a line per draw and the medians. The digests show whether two builds
// simulate identical data. The program uses one thread.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/bench/program.hpp"
#include "tests/tree.hpp"

namespace {

using namespace tumble;  // NOLINT: a program of its own

struct Request {
  std::string scenario;
  std::uint64_t first = 0, last = 0;
};

bool parse(int count, char** words, Request& request) {
  if (count != 4) return false;
  request = {words[1], std::strtoull(words[2], nullptr, 10), std::strtoull(words[3], nullptr, 10)};
  return request.first <= request.last;
}

int run(const Request& request) {
  const scenarios::DataRoot data{test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, request.scenario);
  std::vector<double> bare_s, whole_s;
  std::printf("%6s %9s %9s  %-32s  %s\n", "seed", "no lidar", "lidar", "digest without lidar", "with");
  bench::for_each_draw(request.first, request.last, [&](std::uint64_t seed) {
    const auto bare = scenarios::simulate_draw(data, scenario, seed, 1, scenarios::Lidars::left_out);
    const auto whole = scenarios::simulate_draw(data, scenario, seed, 1);
    bare_s.push_back(bare.simulate_cpu_s);
    whole_s.push_back(whole.simulate_cpu_s);
    std::printf("%6llu %7.3f s %7.3f s  %s  %s\n", static_cast<unsigned long long>(seed), bare_s.back(), whole_s.back(),
                bare.recording_digest.c_str(), whole.recording_digest.c_str());
    std::fflush(stdout);
  });
  if (bare_s.empty()) return 1;
  std::printf("%6s %7.3f s %7.3f s\n", "median", scenarios::quantile(bare_s, 0.5), scenarios::quantile(whole_s, 0.5));
  return 0;
}

}  // namespace

int main(int count, char** words) {
  return bench::run_program<Request>(count, words, "simulation_cost SCENARIO FIRST LAST", parse, run);
}
