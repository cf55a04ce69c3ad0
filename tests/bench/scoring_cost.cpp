// SPDX-License-Identifier: BSD-3-Clause
// scoring_cost SCENARIO FIRST LAST METHOD...
//
// The program measures the processor time (user and system) of the verdict and the scores of an estimate, and that of
// the estimate. It prints a line per draw and method, the medians and the overall mean. Equal digests of the scores
// show that two builds scored the same bits. The method's name has the form that `tumble run` accepts.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/lidar/surface.hpp"
#include "tests/bench/program.hpp"
#include "tests/tree.hpp"

namespace {

using namespace tumble;  // NOLINT: a program of its own

struct Request {
  std::string scenario;
  std::uint64_t first = 0, last = 0;
  std::vector<std::string> methods;
};

bool parse(int count, char** words, Request& request) {
  if (count < 5) return false;
  request = {words[1], std::strtoull(words[2], nullptr, 10), std::strtoull(words[3], nullptr, 10),
             std::vector<std::string>(words + 4, words + count)};
  return request.first <= request.last;
}

struct Cost {
  double estimate_s = 0, scoring_s = 0;
};

/// Returns the digest of verdict and scores alone, bit by bit.
std::string digest_of(const scenarios::Outcome& outcome, std::size_t first) {
  std::vector<std::string> lines = {to_string(outcome.status)};
  for (std::size_t k = first; k < outcome.scores.size(); ++k) {
    char value[40];
    std::snprintf(value, sizeof value, " %a", outcome.scores[k].value);
    lines.push_back(outcome.scores[k].metric + value);
  }
  return scenarios::digest_of_texts(lines);
}

Cost measure(const scenarios::Method& method, const scenarios::SimulatedDraw& draw, const sim::Surface* surface) {
  scenarios::Outcome outcome;
  const double begin_s = scenarios::process_cpu_s();
  const scenarios::Estimate estimate = run_method(method, draw, outcome);
  const double answered_s = scenarios::process_cpu_s();
  const std::size_t costs = outcome.scores.size();
  assess(method, draw, surface, estimate, outcome);
  const Cost cost{answered_s - begin_s, scenarios::process_cpu_s() - answered_s};
  std::printf("%6llu  %-28s %9.3f s %9.4f s  %s\n", static_cast<unsigned long long>(draw.seed),
              full_name(method.info).c_str(), cost.estimate_s, cost.scoring_s, digest_of(outcome, costs).c_str());
  std::fflush(stdout);
  return cost;
}

void print_sums(const std::map<std::string, std::vector<Cost>>& by_method) {
  double all_s = 0.0;
  for (const auto& [name, costs] : by_method) {
    std::vector<double> estimate_s, scoring_s;
    for (const Cost& cost : costs) {
      estimate_s.push_back(cost.estimate_s);
      scoring_s.push_back(cost.scoring_s);
    }
    const double mean_s = std::accumulate(scoring_s.begin(), scoring_s.end(), 0.0) / static_cast<double>(costs.size());
    all_s += mean_s;
    std::printf("median  %-28s %9.3f s %9.4f s  mean %.4f s\n", name.c_str(), scenarios::quantile(estimate_s, 0.5),
                scenarios::quantile(scoring_s, 0.5), mean_s);
  }
  std::printf("scoring a draw of all methods: mean %.4f s\n", all_s);
}

int run(const Request& request) {
  const scenarios::DataRoot data{test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, request.scenario);
  const std::vector<scenarios::MethodPointer> methods = scenarios::find_methods(request.methods);
  std::map<std::string, std::vector<Cost>> by_method;
  std::printf("%6s  %-28s %11s %11s\n", "seed", "method", "estimate", "scoring");
  bench::for_each_draw(request.first, request.last, [&](std::uint64_t seed) {
    const scenarios::SimulatedDraw draw = scenarios::simulate_draw(data, scenario, seed, 1);
    const sim::Surface surface(*draw.built);
    for (const scenarios::MethodPointer& method : methods)
      by_method[full_name(method->info)].push_back(measure(*method, draw, &surface));
  });
  if (by_method.empty()) return 1;
  print_sums(by_method);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  return bench::run_program<Request>(count, words, "scoring_cost SCENARIO FIRST LAST METHOD...", parse, run);
}
