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

/// What a method reached on one draw of a bench suite.
struct BenchDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string group;      ///< class of the suite: "mild"
  std::string recording;  ///< digest of what it was given
  OutcomeStatus status = OutcomeStatus::failed;
  std::map<std::string, double> values;  ///< what the gate holds and the suite shows, and the cost; finite
  bool is(const BenchDraw& other) const { return scenario == other.scenario && seed == other.seed; }
};

/// What one method reached on a bench suite: one line of JSON that can be published. README.md has the schema.
struct BenchResult {
  std::string suite, suite_digest;  ///< bench.hpp
  Kind kind = Kind::rate;
  std::string method;
  std::string version;  ///< of a method that is not of the build; else empty
  std::string source;   ///< paper or "ours"
  std::string build;    ///< provenance/build_id.hpp
  std::string command, date;
  std::vector<BenchDraw> draws;  ///< in the suite's order
  const BenchDraw* find(const BenchDraw& draw) const;
};

/// One line, not ended.
std::string to_line(const BenchResult& result);

/// Reads it back. Throws BadInput that begins with `place`: not JSON, another format or version of it, a key that is
/// missing or of another type, an unknown kind or status, a draw that stands twice.
BenchResult parse_bench_result(const std::string& line, const std::string& place);

/// Of the results that the tree holds of a suite: SUITE.jsonl.
std::filesystem::path bench_results_file(const DataRoot& data, const std::string& suite);

/// The results in a file, a line each; empty lines are passed over. None where there is no such file.
std::vector<BenchResult> read_bench_results(const std::filesystem::path& file);

/// Puts the results into the file, each in the place of the one of its method.
void store_bench_results(const std::filesystem::path& file, const std::vector<BenchResult>& results);

}  // namespace tumble::scenarios
