// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/summary/selection.hpp"
#include "tools/report/badge.hpp"
#include "tools/report/curves.hpp"
#include "tools/report/distributions.hpp"
#include "tools/report/sensitivity_html.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/numbers_of_draws.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::MethodSummary;
using scenarios::metric_info;
using scenarios::MetricSummary;
using scenarios::Section;
using scenarios::Summary;
using scenarios::Wins;

struct ReportVerbOptions {
  std::filesystem::path database, page, badge;
  bool all = false;
};

std::string wins_text(const Wins& wins) {
  return wins.pairs == 0 ? "" : fmt::format("{} of {}", wins.count, wins.pairs);
}

Table score_table(const Section& section, bool all) {
  Table table(
      fmt::format("{}: scores of {} methods; each method is compared with {}", section.scenario,
                  to_string(section.kind), section.baseline),
      {"metric", "method", "draws", "median", "95 % interval", "worst 5 %", "better in", "not ok", "at most (95 %)"});
  table.align_right_from(2);
  for (const std::string& name : all ? section.metrics : scenarios::headline_metrics(section.kind)) {
    bool first = true;
    for (const MethodSummary& method : section.methods) {
      const MetricSummary* metric = method.find(name);
      if (metric == nullptr) continue;
      table.add_row({first ? name : "", method.method, std::to_string(metric->values.size() + metric->failed.size()),
                     number_text(metric->centre.value), interval_text(metric->centre), number_text(metric->quantile_95),
                     wins_text(metric->wins), fmt::format("{} of {}", method.not_ok, method.outcomes),
                     fmt::format("{:.1f} %", 100.0 * method.not_ok_share.high)});
      first = false;
    }
  }
  return table;
}

Table draws_table(const Summary& summary) {
  Table table("draws", {"scenario", "scored", "rejected"});
  table.align_right_from(1);
  for (const std::string& scenario : summary.scenarios) {
    const auto rejected = summary.rejected.find(scenario);
    table.add_row({scenario, std::to_string(summary.draws.at(scenario)),
                   std::to_string(rejected == summary.rejected.end() ? 0 : rejected->second)});
  }
  return table;
}

json to_json(const Summary& summary) {
  json rows = json::array();
  for (const Section& section : summary.sections) {
    for (const MethodSummary& method : section.methods) {
      json row = {{"scenario", section.scenario},
                  {"kind", to_string(section.kind)},
                  {"method", method.method},
                  {"baseline", section.baseline},
                  {"outcomes", method.outcomes},
                  {"not_ok", method.not_ok},
                  {"not_ok_share", interval_json(method.not_ok_share)},
                  {"metrics", json::object()}};
      for (const auto& [name, metric] : method.metrics) {
        row["metrics"][name] = {
            {metric_info(name).unit == scenarios::Unit::verdict ? "share" : "median", interval_json(metric.centre)},
            {"quantile_95", finite(metric.quantile_95)},
            {"count", metric.values.size()},
            {"better_in", metric.wins.count},
            {"pairs", metric.wins.pairs}};
      }
      rows.push_back(std::move(row));
    }
  }
  return {{"draws", summary.draws}, {"rejected", summary.rejected}, {"scores", std::move(rows)}};
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream.good() && !stream.eof())
    throw scenarios::BadInput(fmt::format("{}: the file cannot be read; give an existing file", path.string()));
  return text;
}

std::string data_found(const Session& session) {
  try {
    return scenarios::data_digest(session.data());
  } catch (const scenarios::BadInput&) {
    return "";
  }
}

/// Maximum number of simulated runs per scenario for the sensitivity section of a page
constexpr std::size_t kSensitivityDraws = 2000;

void add_sensitivity(const Session& session, const std::string& data_found, ReportInput& input) {
  const Summary some = scenarios::at_most_draws(*input.summary, kSensitivityDraws);
  NumbersByScenario numbers;
  const std::string made_of = input.results->note("data");
  if (!made_of.empty() && made_of == data_found) {
    numbers = numbers_of_catalogue(session, session.data(), some);
  } else {
    numbers = numbers_of_motions(input.draws, some);
    input.sensitivity_note =
        "The random parameters of these simulated runs are unknown, because the results come from other models and "
        "scenarios. The page therefore lists the influence of the motions (for example the largest rate) instead. ";
  }
  scenarios::SensitivityOptions options;
  for (const Section& section : input.summary->sections) {
    const std::vector<std::string> metrics = scenarios::headline_metrics(section.kind);
    if (!metrics.empty() && std::count(options.metrics.begin(), options.metrics.end(), metrics.front()) == 0 &&
        std::count(section.metrics.begin(), section.metrics.end(), metrics.front()) > 0)
      options.metrics.push_back(metrics.front());
  }
  input.sensitivity = scenarios::sensitivities(some, numbers, options);
  const std::string needed = draws_needed_text(input.summary->draws);
  input.sensitivity_note += needed;
  if (input.sensitivity.empty() && needed.empty())
    input.sensitivity_note +=
        "All known parameters of a scenario are equal in all simulated runs, so the page shows no influence of "
        "parameters. ";
  for (const auto& [scenario, draws] : input.summary->draws) {
    if (draws <= static_cast<std::int64_t>(kSensitivityDraws)) continue;
    input.sensitivity_note += fmt::format(
        "The analysis uses at most {} simulated runs per scenario, with evenly spaced seeds.", kSensitivityDraws);
    break;
  }
}

PageContent content_of(const Session& session, const ReportVerbOptions& options, ReportInput input) {
  ReportOptions report;
  report.database = options.database;
  report.page = options.page;
  report.version = program_version();
  report.data = data_found(session);
  report.made_at = fmt::format("{:%Y-%m-%d %H:%M} UTC",
                               fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  add_sensitivity(session, report.data, input);
  return report_content(std::move(input), report);
}

void write_page(const Session& session, const ReportVerbOptions& options, ReportInput input) {
  const std::string plotly = options.page.empty() ? "" : read_text(session.plotly());
  const PageContent content = content_of(session, options, std::move(input));
  // Page and badge are complete before the first is moved, so that a full disk leaves neither.
  std::list<scenarios::OutputFile> files;
  const auto write = [&](const std::filesystem::path& path, const std::string& text) {
    files.emplace_back(path).write(std::as_bytes(std::span(text)));
  };
  if (!options.badge.empty()) write(options.badge, badge_svg(badge_of(content)));
  if (!options.page.empty()) {
    for (const std::string& warning : content.warnings) session.note(warning);
    write(options.page, page_html(content, plotly));
  }
  for (scenarios::OutputFile& file : files) file.move_into_place();
}

int report(const Session& session, const ReportVerbOptions& options) {
  const std::vector<std::filesystem::path> inputs = {options.database};
  if (!options.page.empty()) prepare_file(options.page, inputs, {".html"});
  if (!options.badge.empty()) prepare_file(options.badge, inputs, {".svg"});
  const scenarios::Results results(options.database, scenarios::Results::Mode::read_only);
  const std::vector<scenarios::DrawValues> draws = results.draws();
  Summary summary;
  std::vector<Curve> curves = scenarios::find_curves(results, draws, summary);
  if (summary.scenarios.empty() && curves.empty())
    throw scenarios::BadInput(
        fmt::format("{}: this database contains no outcomes, so there is nothing to report; run 'tumble sweep' first",
                    options.database.string()));
  std::vector<Table> tables;
  for (const Section& section : summary.sections) {
    Table table = score_table(section, options.all);
    if (!table.empty()) tables.push_back(std::move(table));
  }
  for (const Curve& curve : curves) {
    if (options.all || curve.source == Curve::Source::set) tables.push_back(curve_table(curve));
  }
  std::vector<Spread> motions = scenarios::motion_spreads(draws);
  if (!motions.empty()) tables.push_back(distribution_table(motions));
  tables.push_back(draws_table(summary));
  json document = to_json(summary);
  document["curves"] = curves_json(curves);
  document["motions"] = distributions_json(motions);
  document["certificates"] = json::array();
  for (const scenarios::Certificate& certificate : results.certificates()) {
    document["certificates"].push_back(json::parse(to_json(certificate)));
  }
  if (!options.page.empty() || !options.badge.empty())
    write_page(session, options, {&results, &summary, draws, std::move(curves), std::move(motions), {}, {}});
  session.print(tables, document);
  return kDone;
}

}  // namespace

Action declare_report(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<ReportVerbOptions>();
  verb.add("DATABASE", options->database, "results database, FILE.db").required();
  verb.add("-o,--output", options->page, "writes the report as a web page to FILE.html [default: only prints tables]");
  verb.add("--badge", options->badge,
           "writes a badge to FILE.svg. The badge shows the suite, and the number of scenarios in which a method is "
           "better than the baseline method");
  verb.add_flag("--all", options->all,
                "prints all metrics, including metrics per range of clipping depth and clipping duration [default: "
                "only the most important metrics]");
  return [&session, options] { return report(session, *options); };
}

}  // namespace tumble::tools
