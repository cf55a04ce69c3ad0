// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/scoring/outcome_status.hpp"

namespace tumble::scenarios {

struct BenchDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string group;      ///< class of runs in the suite: "mild"
  std::string recording;  ///< digest of the recording
  OutcomeStatus status = OutcomeStatus::failed;
  std::map<std::string, double> values;  ///< metric values, all finite
  bool is(const BenchDraw& other) const { return scenario == other.scenario && seed == other.seed; }
};

struct BenchResult {
  std::string suite, suite_digest;  ///< see bench.hpp
  Kind kind = Kind::rate;
  std::string method;
  std::string version;  ///< version of an external method, else empty
  std::string source;   ///< paper or "ours"
  std::string build;    ///< provenance/build_id.hpp
  std::string command, date;
  std::vector<BenchDraw> draws;  ///< in the suite's order
  const BenchDraw* find(const BenchDraw& draw) const;
};

std::string to_line(const BenchResult& result);

BenchResult parse_bench_result(const std::string& line, const std::string& place);

std::filesystem::path bench_results_file(const DataRoot& data, const std::string& suite);

std::vector<BenchResult> read_bench_results(const std::filesystem::path& file);

void store_bench_results(const std::filesystem::path& file, const std::vector<BenchResult>& results);

}  // namespace tumble::scenarios
