// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/outcome_status.hpp"

namespace tumble::scenarios {

/// Result of one method on one draw of a bench suite.
struct BenchDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string group;      ///< class in the suite: "mild"
  std::string recording;  ///< digest of the input
  OutcomeStatus status = OutcomeStatus::failed;
  std::map<std::string, double> values;  ///< gate metrics, the suite's metrics, and the cost; finite
  bool is(const BenchDraw& other) const { return scenario == other.scenario && seed == other.seed; }
};

/// Result of one method on a bench suite, published as one line of JSON. Schema: README.md.
struct BenchResult {
  std::string suite, suite_digest;  ///< see bench.hpp
  Kind kind = Kind::rate;
  std::string method;
  std::string version;  ///< of an external method, else empty
  std::string source;   ///< paper or "ours"
  std::string build;    ///< provenance/build_id.hpp
  std::string command, date;
  std::vector<BenchDraw> draws;  ///< in the suite's order
  const BenchDraw* find(const BenchDraw& draw) const;
};

/// Returns one line of JSON without newline.
std::string to_line(const BenchResult& result);

/// Parses such a line. Throws BadInput, with a message that starts with `place`: not JSON, another format or version, a
/// missing key or wrong type, an unknown kind or status, a repeated draw.
BenchResult parse_bench_result(const std::string& line, const std::string& place);

/// Returns the path of a suite's stored results: SUITE.jsonl.
std::filesystem::path bench_results_file(const DataRoot& data, const std::string& suite);

/// Returns the results in a file, one per line, ignoring empty lines; none if the file does not exist.
std::vector<BenchResult> read_bench_results(const std::filesystem::path& file);

/// Stores results in the file; each replaces the one of its method.
void store_bench_results(const std::filesystem::path& file, const std::vector<BenchResult>& results);

}  // namespace tumble::scenarios
