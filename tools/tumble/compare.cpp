// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/asked.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::BadInput;
using scenarios::Comparison;
using scenarios::Contest;
using scenarios::FailureComparison;
using scenarios::Finding;
using scenarios::MetricComparison;

struct Options {
  std::filesystem::path database;
  std::vector<std::string> methods, metrics;
  std::string against, margin;
  double risk = 0.05, power = 0.8;
};

/// One method against the baseline, or against the one that is named last.
scenarios::ComparisonOptions read(const Options& options) {
  scenarios::ComparisonOptions out;
  out.methods = options.methods;
  out.against = options.against;
  if (out.against.empty() && out.methods.size() > 1) {
    out.against = out.methods.back();
    out.methods.pop_back();
  }
  out.metrics = options.metrics;
  if (!options.margin.empty()) out.margin = parse_margin("--margin", options.margin);
  if (out.margin && !out.margin->relative && out.metrics.empty())
    throw BadInput("--margin " + options.margin +
                   " is in the unit of a metric: name it with --metric, or give a share, as 10%");
  out.risk = options.risk;
  out.power = options.power;
  return out;
}

std::string interval_text(const scenarios::Interval& interval) {
  if (!std::isfinite(interval.low) && !std::isfinite(interval.high)) return "[-]";
  return "[" + number_text(interval.low) + ", " + number_text(interval.high) + "]";
}

std::string title_of(const Contest& contest, const std::string& what) {
  return fmt::format("{}: {}, {}", contest.scenario, to_string(contest.kind), what);
}

bool one_section(const Contest& a, const Contest& b) {
  return a.scenario == b.scenario && a.kind == b.kind && a.against == b.against;
}

std::vector<Table> metric_tables(const std::vector<MetricComparison>& rows, bool margin) {
  std::vector<Table> tables;
  std::vector<std::string> header = {
      "metric",         "method", "draws",         "median", "against", "median difference", "95 % (BCa)",
      "better : worse", "sign p", "signed rank p", "Holm p", "finding", "more draws"};
  if (margin) header.insert(header.end(), {"no worse p", "Holm p", "no worse"});
  const Contest* open = nullptr;
  for (const MetricComparison& row : rows) {
    if (open == nullptr || !one_section(*open, row.contest)) {
      tables.emplace_back(title_of(row.contest, "paired with " + row.contest.against), header);
      tables.back().align_right_from(2);
      open = &row.contest;
    }
    std::vector<std::string> cells = {row.metric,
                                      row.contest.method,
                                      std::to_string(row.pairs),
                                      number_text(row.median),
                                      number_text(row.against_median),
                                      number_text(row.difference.value),
                                      interval_text(row.difference),
                                      fmt::format("{} : {}", row.better, row.worse),
                                      chance_text(row.sign_chance),
                                      chance_text(row.rank_chance),
                                      chance_text(row.corrected),
                                      to_string(row.finding),
                                      more_draws_text(row.pairs_needed, row.pairs, row.finding == Finding::undecided)};
    if (margin) {
      cells.push_back(chance_text(row.not_inferior_chance));
      cells.push_back(chance_text(row.not_inferior_corrected));
      cells.emplace_back(row.not_inferior ? "yes" : "not shown");
    }
    tables.back().add_row(std::move(cells));
  }
  return tables;
}

std::string share_text(const scenarios::Interval& share) {
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}]", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high);
}

std::vector<Table> failure_tables(const std::vector<FailureComparison>& rows) {
  std::vector<Table> tables;
  const Contest* open = nullptr;
  for (const FailureComparison& row : rows) {
    if (open == nullptr || !one_section(*open, row.contest)) {
      tables.emplace_back(
          title_of(row.contest, "failures, paired with " + row.contest.against),
          std::vector<std::string>{"failure", "method", "draws", "share [95 %]", "against [95 %]", "it alone",
                                   "the other alone", "McNemar p", "Holm p", "finding", "more draws"});
      tables.back().align_right_from(2);
      open = &row.contest;
    }
    tables.back().add_row({row.what, row.contest.method, std::to_string(row.pairs), share_text(row.share),
                           share_text(row.against_share), std::to_string(row.only_method),
                           std::to_string(row.only_against), chance_text(row.chance), chance_text(row.corrected),
                           to_string(row.finding),
                           more_draws_text(row.pairs_needed, row.pairs, row.finding == Finding::undecided)});
  }
  return tables;
}

json finite(double value) {
  return std::isfinite(value) ? json(value) : json();
}

json interval_json(const scenarios::Interval& i) {
  return {{"value", finite(i.value)}, {"low", finite(i.low)}, {"high", finite(i.high)}};
}

json contest_json(const Contest& contest) {
  return {{"scenario", contest.scenario},
          {"kind", to_string(contest.kind)},
          {"method", contest.method},
          {"against", contest.against}};
}

json to_json(const Comparison& comparison, bool margin) {
  json metrics = json::array(), failures = json::array();
  for (const MetricComparison& row : comparison.metrics) {
    json each = contest_json(row.contest);
    each.update({{"metric", row.metric},
                 {"pairs", row.pairs},
                 {"better", row.better},
                 {"worse", row.worse},
                 {"median", finite(row.median)},
                 {"against_median", finite(row.against_median)},
                 {"difference", interval_json(row.difference)},
                 {"sign_p", row.sign_chance},
                 {"signed_rank_p", row.rank_chance},
                 {"holm_p", finite(row.corrected)},
                 {"finding", to_string(row.finding)},
                 {"pairs_needed", finite(row.pairs_needed)}});
    if (margin) {
      each["not_inferior_p"] = finite(row.not_inferior_chance);
      each["not_inferior_holm_p"] = finite(row.not_inferior_corrected);
      each["not_inferior"] = row.not_inferior;
    }
    metrics.push_back(std::move(each));
  }
  for (const FailureComparison& row : comparison.failures) {
    json each = contest_json(row.contest);
    each.update({{"failure", row.what},
                 {"pairs", row.pairs},
                 {"share", interval_json(row.share)},
                 {"against_share", interval_json(row.against_share)},
                 {"only_method", row.only_method},
                 {"only_against", row.only_against},
                 {"mcnemar_p", row.chance},
                 {"holm_p", row.corrected},
                 {"finding", to_string(row.finding)},
                 {"pairs_needed", finite(row.pairs_needed)}});
    failures.push_back(std::move(each));
  }
  return {{"metrics", std::move(metrics)}, {"failures", std::move(failures)}};
}

int compare(const Session& session, const Options& options) {
  const scenarios::ComparisonOptions asked = read(options);
  const scenarios::Results results(options.database, scenarios::Results::Mode::read_only);
  const Comparison comparison = scenarios::compare(scenarios::summarize(results), asked);
  if (comparison.failures.empty())
    throw BadInput(options.database.string() + ": holds no draw on which two of the methods asked for have run");
  std::vector<Table> tables = metric_tables(comparison.metrics, asked.margin.has_value());
  for (Table& table : failure_tables(comparison.failures)) tables.push_back(std::move(table));
  session.print(tables, to_json(comparison, asked.margin.has_value()));
  session.note(fmt::format(
      "risk {:g} of any false finding among the {} of the metrics, and again among the {} of failures (Holm); "
      "docs/maths/statistics.md",
      options.risk, comparison.metrics.size(), comparison.failures.size()));
  return kDone;
}

}  // namespace

Action declare_compare(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<Options>();
  verb.add("DATABASE", options->database, "a results database, FILE.db").required();
  verb.add("--method", options->methods,
           "the method to compare; of several each with the last [all that need no truth, with the baseline]")
      .one_at_a_time();
  verb.add("--against", options->against, "what it is paired with [the last --method, or the baseline]");
  verb.add("--metric", options->metrics, "a metric; repeat for more [the headline ones of the kind]").one_at_a_time();
  verb.add("--margin", options->margin,
           "how much worse still counts as no worse: in the metric's unit, or as 10% of the other's value");
  verb.add("--risk", options->risk, "of any false finding of the table").within(1e-6, 0.5).shows_default();
  verb.add("--power", options->power, "that the draws wanted are to have").within(0.5, 0.999).shows_default();
  return [&session, options] { return compare(session, *options); };
}

}  // namespace tumble::tools
