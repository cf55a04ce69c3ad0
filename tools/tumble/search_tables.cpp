// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/search_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/tumble/intervals.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::InputShift;
using scenarios::Interval;
using scenarios::SplittingLevel;

/// Shifts are listed up to this number.
constexpr std::size_t kShiftsShown = 5;

Table probability_table(const ShownSearch& shown) {
  const scenarios::SearchResult& result = shown.result;
  Table table(fmt::format("{}: probability that {} fails ({})", shown.scenario, shown.method, shown.goal.text()),
              {"probability", "95 % interval", "bound reached", "runs", "failures found", "not simulated",
               "independent runs for this interval"});
  const Interval& p = result.splitting.probability;
  table.add_row({number_text(p.value), interval_text(p), result.splitting.complete ? "yes" : "no",
                 std::to_string(result.splitting.draws.size()), std::to_string(result.failures),
                 std::to_string(result.rejected), number_text(plain_draws(p))});
  return table;
}

Table levels_table(const ShownSearch& shown) {
  Table table(fmt::format("{}: levels of {}", shown.scenario, shown.goal.metric),
              {"level", "probability", "95 % interval", "runs", "initial runs", "moves", "accepted"});
  for (const SplittingLevel& level : shown.result.splitting.levels) {
    table.add_row({number_text(shown.goal.value_at(level.score)), number_text(level.probability.value),
                   interval_text(level.probability), std::to_string(level.runs), std::to_string(level.families),
                   std::to_string(level.moves), fmt::format("{:.0f} %", 100.0 * level.accepted)});
  }
  return table;
}

Table shifts_table(const ShownSearch& shown) {
  Table table(fmt::format("{}: random parameters of the worst simulated runs", shown.scenario),
              {"number", "shift [sigma]", "Holm p", "quantiles 0.1, 0.5, 0.9 in these runs", "in the scenario"});
  for (std::size_t i = 0; i < shown.result.shifts.size() && i < kShiftsShown; ++i) {
    const InputShift& each = shown.result.shifts[i];
    const auto three = [](double low, double middle, double high) {
      return fmt::format("{}, {}, {}", number_text(low), number_text(middle), number_text(high));
    };
    table.add_row({each.number, fmt::format("{:+.2f}", each.shift), chance_text(each.corrected),
                   three(each.low, each.median, each.high),
                   three(each.scenario_low, each.scenario_median, each.scenario_high)});
  }
  return table;
}

Table draws_table(const ShownSearch& shown) {
  Table table(fmt::format("{}: simulated runs that the search found", shown.scenario),
              {"run", "status", shown.goal.metric, "distance [sigma]", "command"});
  for (const ShownDraw& each : shown.draws) {
    table.add_row({std::to_string(each.found.run), to_string(each.found.status), number_text(each.found.value),
                   fmt::format("{:.2f}", each.found.distance), each.command});
  }
  return table;
}

json shift_json(const InputShift& each) {
  return {{"number", each.number},
          {"shift", each.shift},
          {"holm_p", each.corrected},
          {"draws", {each.low, each.median, each.high}},
          {"scenario", {each.scenario_low, each.scenario_median, each.scenario_high}}};
}

}  // namespace

double plain_draws(const Interval& p) {
  constexpr double kSigmas = 1.959963984540054;
  if (p.value <= 0.0 || p.low <= 0.0) return -std::log(0.025) / p.high;
  const double deviation = std::log(p.high / p.low) / (2.0 * kSigmas);
  return (1.0 - p.value) / (p.value * deviation * deviation);
}

std::vector<Table> tables_of(const ShownSearch& shown) {
  std::vector<Table> out = {probability_table(shown)};
  for (Table& table : std::vector<Table>{levels_table(shown), shifts_table(shown), draws_table(shown)}) {
    if (!table.empty()) out.push_back(std::move(table));
  }
  return out;
}

json json_of(const ShownSearch& shown) {
  const scenarios::SearchResult& result = shown.result;
  json levels = json::array(), shifts = json::array(), draws = json::array();
  for (const SplittingLevel& level : result.splitting.levels) {
    levels.push_back({{"level", finite(shown.goal.value_at(level.score))},
                      {"probability", interval_json(level.probability)},
                      {"runs", level.runs},
                      {"families", level.families},
                      {"moves", level.moves},
                      {"accepted", level.accepted}});
  }
  for (const InputShift& each : result.shifts) shifts.push_back(shift_json(each));
  for (const ShownDraw& each : shown.draws) {
    draws.push_back({{"run", each.found.run},
                     {"status", to_string(each.found.status)},
                     {"value", finite(each.found.value)},
                     {"distance", each.found.distance},
                     {"seed", each.found.seed},
                     {"command", each.command}});
  }
  return {{"scenario", shown.scenario},
          {"method", shown.method},
          {"failure", shown.goal.text()},
          {"probability", interval_json(result.splitting.probability)},
          {"reached", result.splitting.complete},
          {"runs", result.splitting.draws.size()},
          {"failures", result.failures},
          {"rejected", result.rejected},
          {"plain_draws", finite(plain_draws(result.splitting.probability))},
          {"levels", std::move(levels)},
          {"numbers", std::move(shifts)},
          {"draws", std::move(draws)}};
}

}  // namespace tumble::tools
