// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/bench/bench_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace {

using nlohmann::ordered_json;

constexpr const char* kFormat = "tumble bench";
constexpr int kBenchFormatVersion = 1;

ordered_json to_json(const BenchDraw& draw) {
  ordered_json values = ordered_json::object();
  for (const auto& [metric, value] : draw.values)
    if (std::isfinite(value)) values[metric] = value;
  return {{"scenario", draw.scenario},
          {"seed", draw.seed},
          {"class", draw.group},
          {"recording", draw.recording},
          {"status", to_string(draw.status)},
          {"values", std::move(values)}};
}

BenchDraw draw_from(const ordered_json& node) {
  BenchDraw draw;
  draw.scenario = node.at("scenario").get<std::string>();
  draw.seed = node.at("seed").get<std::uint64_t>();
  draw.group = node.at("class").get<std::string>();
  draw.recording = node.at("recording").get<std::string>();
  const auto status = outcome_status_named(node.at("status").get<std::string>());
  if (!status) throw BadInput("unknown status '" + node.at("status").get<std::string>() + "'");
  draw.status = *status;
  for (const auto& [metric, value] : node.at("values").items()) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      throw BadInput(fmt::format("the value of metric '{}' is not a finite number", metric));
    draw.values[metric] = value.get<double>();
  }
  return draw;
}

BenchResult result_from(const ordered_json& node) {
  if (!node.is_object() || node.value("format", "") != kFormat)
    throw BadInput(fmt::format("this line is not a bench result, because its key 'format' is not '{}'", kFormat));
  const ordered_json version = node.value("format_version", ordered_json());
  if (version != kBenchFormatVersion)
    throw BadInput(fmt::format("format_version is {}; it must be {}", version.dump(), kBenchFormatVersion));
  BenchResult result;
  const auto text = [&](const char* key) { return node.at(key).get<std::string>(); };
  result.suite = text("suite");
  result.suite_digest = text("suite_digest");
  const auto kind = kind_named(text("kind"));
  if (!kind) throw BadInput("unknown kind '" + text("kind") + "'");
  result.kind = *kind;
  result.method = text("method");
  result.version = text("version");
  result.source = text("source");
  result.build = text("build");
  result.command = text("command");
  result.date = text("date");
  for (const ordered_json& each : node.at("draws")) {
    BenchDraw draw = draw_from(each);
    if (result.find(draw) != nullptr)
      throw BadInput(fmt::format("the simulated run of scenario {} with seed {} occurs twice; each run may occur once",
                                 draw.scenario, draw.seed));
    result.draws.push_back(std::move(draw));
  }
  return result;
}

}  // namespace

const BenchDraw* BenchResult::find(const BenchDraw& draw) const {
  const auto it = std::find_if(draws.begin(), draws.end(), [&](const BenchDraw& each) { return each.is(draw); });
  return it == draws.end() ? nullptr : &*it;
}

std::string to_line(const BenchResult& result) {
  ordered_json draws = ordered_json::array();
  for (const BenchDraw& draw : result.draws) draws.push_back(to_json(draw));
  const ordered_json line = {{"format", kFormat},
                             {"format_version", kBenchFormatVersion},
                             {"suite", result.suite},
                             {"suite_digest", result.suite_digest},
                             {"kind", to_string(result.kind)},
                             {"method", result.method},
                             {"version", result.version},
                             {"source", result.source},
                             {"build", result.build},
                             {"command", result.command},
                             {"date", result.date},
                             {"draws", std::move(draws)}};
  return line.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

BenchResult parse_bench_result(const std::string& line, const std::string& place) {
  try {
    return result_from(ordered_json::parse(line));
  } catch (const ordered_json::exception& error) {
    throw BadInput(place + ": " + error.what());
  } catch (const BadInput& error) {
    throw BadInput(place + ": " + error.what());
  }
}

std::filesystem::path bench_results_file(const DataRoot& data, const std::string& suite) {
  return data.root / "scenarios" / "bench" / "results" / (suite + ".jsonl");
}

std::vector<BenchResult> read_bench_results(const std::filesystem::path& file) {
  std::vector<BenchResult> results;
  if (!std::filesystem::exists(file)) return results;
  std::istringstream stream(read_text_file(file));
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      results.push_back(parse_bench_result(line, file.string() + ":" + std::to_string(number)));
  return results;
}

void store_bench_results(const std::filesystem::path& file, const std::vector<BenchResult>& results) {
  std::vector<BenchResult> stored = read_bench_results(file);
  for (const BenchResult& result : results) {
    const auto same = [&](const BenchResult& each) { return each.kind == result.kind && each.method == result.method; };
    const auto place = std::find_if(stored.begin(), stored.end(), same);
    if (place == stored.end())
      stored.push_back(result);
    else
      *place = result;
  }
  std::string text;
  for (const BenchResult& each : stored) text += to_line(each) + "\n";
  replace_file(file, text);
}

}  // namespace tumble::scenarios
