// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>

#include "scenarios/certificate/certificate_text.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "tools/report/curves.hpp"
#include "tools/report/distributions.hpp"
#include "tools/tumble/arguments.hpp"
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

struct Options {
  std::filesystem::path database, page;
  bool all = false;
};

std::string interval_text(const scenarios::Interval& interval) {
  if (!std::isfinite(interval.low) && !std::isfinite(interval.high)) return "[-]";
  return "[" + number_text(interval.low) + ", " + number_text(interval.high) + "]";
}

std::string wins_text(const Wins& wins) {
  return wins.pairs == 0 ? "" : fmt::format("{} of {}", wins.count, wins.pairs);
}

/// A row per method and metric: the headline metrics, or all of them.
Table score_table(const Section& section, bool all) {
  Table table(
      fmt::format("{}: {} (paired with {})", section.scenario, to_string(section.kind), section.baseline),
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

json finite(double value) {
  return std::isfinite(value) ? json(value) : json();
}

json interval_json(const scenarios::Interval& i) {
  return {{"value", finite(i.value)}, {"low", finite(i.low)}, {"high", finite(i.high)}};
}

/// Everything that the page's tables hold, in SI units.
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
  if (!stream.good() && !stream.eof()) throw scenarios::BadInput(path.string() + ": cannot be read");
  return text;
}

/// Digest of the data that a sweep would take; a report needs none.
std::string data_found(const Session& session) {
  try {
    return scenarios::data_digest(session.data());
  } catch (const scenarios::BadInput&) {
    return "";
  }
}

void write_page(const Session& session, const Options& options, const scenarios::Results& results,
                const Summary& summary) {
  const std::string plotly = read_text(session.plotly());
  ReportOptions report;
  report.database = options.database;
  report.page = options.page;
  report.version = program_version();
  report.data = data_found(session);
  report.made_at = fmt::format("{:%Y-%m-%d %H:%M} UTC",
                               fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  const PageContent content = report_content(results, summary, report);
  for (const std::string& warning : content.warnings) session.note(warning);
  scenarios::replace_file(options.page, page_html(content, plotly));
}

int report(const Session& session, const Options& options) {
  if (!options.page.empty()) prepare_output(options.page, std::vector<std::filesystem::path>{options.database});
  const scenarios::Results results(options.database, scenarios::Results::Mode::read_only);
  const Summary summary = scenarios::summarize(results);
  const std::vector<scenarios::DrawValues> draws = results.draws();
  const std::vector<Curve> curves = scenarios::find_curves(results, draws);
  if (summary.scenarios.empty() && curves.empty())
    throw scenarios::BadInput(options.database.string() + ": holds no outcomes to report");
  std::vector<Table> tables;
  for (const Section& section : summary.sections) {
    Table table = score_table(section, options.all);
    if (!table.empty()) tables.push_back(std::move(table));
  }
  for (const Curve& curve : curves) {
    if (options.all || curve.source == Curve::Source::set) tables.push_back(curve_table(curve));
  }
  const std::vector<Spread> motions = scenarios::motion_spreads(draws);
  if (!motions.empty()) tables.push_back(distribution_table(motions));
  tables.push_back(draws_table(summary));
  json document = to_json(summary);
  document["curves"] = curves_json(curves);
  document["motions"] = distributions_json(motions);
  document["certificates"] = json::array();
  for (const scenarios::Certificate& certificate : results.certificates()) {
    document["certificates"].push_back(json::parse(to_json(certificate)));
  }
  // the page first: that nobody reads standard output costs nobody the page
  if (!options.page.empty()) write_page(session, options, results, summary);
  session.print(tables, document);
  return kDone;
}

}  // namespace

Action declare_report(CLI::App& app, const Session& session) {
  auto options = std::make_shared<Options>();
  app.add_option("DATABASE", options->database, "a results database, FILE.db")->required();
  app.add_option("-o,--output", options->page, "the page, FILE.html [tables alone]");
  app.add_flag("--all", options->all,
               "all metrics in the printed tables, not the headline ones alone, and the curves over bins");
  return [&session, options] { return report(session, *options); };
}

}  // namespace tumble::tools
