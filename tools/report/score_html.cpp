// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/score_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/html/html.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

namespace {

using scenarios::MethodSummary;
using scenarios::metric_info;
using scenarios::metric_style;
using scenarios::MetricInfo;
using scenarios::MetricStyle;
using scenarios::MetricSummary;
using scenarios::Section;
using scenarios::Sense;

std::string plain(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  if (value < 0.0) return "−" + plain(-value);
  if (value != 0.0 && (std::abs(value) < 1e-3 || std::abs(value) >= 1e6)) return fmt::format("{:.2e}", value);
  const int digits = value == 0.0 ? 0 : std::max(0, 2 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  return fmt::format("{:.{}f}", value, digits);
}

const MethodSummary* best_method(const Section& section, const std::string& metric) {
  const MethodSummary* best = nullptr;
  const MetricInfo& info = metric_info(metric);
  if (info.sense == Sense::none) return best;
  for (const MethodSummary& method : section.methods) {
    const MetricSummary* own = method.find(metric);
    if (own == nullptr || method.needs_truth) continue;
    const double value = own->centre.value;
    // Full coverage is nearer to the target than partial coverage, but any overestimated covariance has full coverage.
    if (info.sense == Sense::two_sided && info.unit == scenarios::Unit::share && info.target < 1.0 && value >= 1.0)
      continue;
    if (best == nullptr || is_better(info, value, best->find(metric)->centre.value)) best = &method;
  }
  return best;
}

std::string failures_text(const MethodSummary& method) {
  return fmt::format("{} of {} runs failed [95 % interval {}–{} %]", method.not_ok, method.outcomes,
                     plain(100.0 * method.not_ok_share.low), plain(100.0 * method.not_ok_share.high));
}

std::string metric_cell(const std::string& name, const MetricSummary* metric, bool is_best) {
  if (metric == nullptr) return html::cell("", "none");
  std::string out = is_best ? "<td class=\"number best\">" : "<td class=\"number\">";
  out += "<b>" + html::escaped(styled_value(name, metric->centre.value, false)) + "</b>";
  out += "<small>" + html::escaped(styled_interval(name, metric->centre)) + "</small>";
  if (metric->wins.pairs > 0) {
    out += "<small class=\"wins\">" +
           html::escaped(fmt::format("better than the baseline in {} of {} simulated runs", metric->wins.count,
                                     metric->wins.pairs)) +
           "</small>";
  }
  return out + "</td>";
}

}  // namespace

std::string styled_value(const std::string& metric, double value_si, bool with_unit) {
  const MetricStyle style = metric_style(metric);
  const std::string number = plain(value_si * style.factor);
  return with_unit && !style.unit.empty() ? number + " " + style.unit : number;
}

std::string styled_interval(const std::string& metric, const scenarios::Interval& interval) {
  if (!std::isfinite(interval.low) && !std::isfinite(interval.high)) return "[–]";
  return "[" + styled_value(metric, interval.low, false) + ", " + styled_value(metric, interval.high, false) + "]";
}

std::string score_table_html(const Section& section) {
  std::string out = "<div class=\"scroll\"><table><thead><tr><th>metric</th><th>unit</th>";
  for (const MethodSummary& method : section.methods) {
    out += "<th class=\"number\">" + html::escaped(method.method) +
           (method.method == section.baseline ? " <small>baseline</small>" : "") + "</th>";
  }
  out += "</tr></thead><tbody><tr><td>not ok</td><td></td>";
  for (const MethodSummary& method : section.methods) {
    out += html::cell(failures_text(method), method.not_ok > 0 ? "number bad" : "number");
  }
  out += "</tr>";
  for (const std::string& name : section.metrics) {
    const MethodSummary* best = best_method(section, name);
    out += "<tr><td title=\"" + html::escaped(metric_info(name).doc) + "\"><code>" + html::escaped(name) +
           "</code></td>" + html::cell(metric_style(name).unit, "unit");
    for (const MethodSummary& method : section.methods) out += metric_cell(name, method.find(name), &method == best);
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

namespace {

using html::cell;
using html::escaped;
using scenarios::Contest;
using scenarios::FailureComparison;
using scenarios::Finding;
using scenarios::MetricComparison;

std::string finding_cell(Finding finding) {
  return cell(to_string(finding), finding == Finding::better ? "good" : finding == Finding::worse ? "bad" : "");
}

std::string row_html(const MetricComparison& row) {
  return "<tr><td><code>" + escaped(row.metric) + "</code></td>" + cell(row.contest.method) +
         cell(std::to_string(row.pairs), "number") + cell(styled_value(row.metric, row.median, true), "number") +
         cell(styled_value(row.metric, row.against_median, true), "number") +
         cell(styled_value(row.metric, row.difference.value, false) + " " + styled_interval(row.metric, row.difference),
              "number") +
         cell(fmt::format("{} : {}", row.better, row.worse), "number") + cell(chance_text(row.corrected), "number") +
         finding_cell(row.finding) +
         cell(more_draws_text(row.pairs_needed, row.pairs, row.finding == Finding::undecided), "number") + "</tr>\n";
}

std::string percent(const scenarios::Interval& share) {
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}]", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high);
}

std::string row_html(const FailureComparison& row) {
  return "<tr><td>" + escaped(row.what) + "</td>" + cell(row.contest.method) +
         cell(std::to_string(row.pairs), "number") + cell(percent(row.share), "number") +
         cell(percent(row.against_share), "number") + cell(std::to_string(row.only_method), "number") +
         cell(std::to_string(row.only_against), "number") + cell(chance_text(row.corrected), "number") +
         finding_cell(row.finding) + "</tr>\n";
}

template <class Row>
std::string folded_tables(const std::vector<Row>& rows, const std::vector<std::string>& columns) {
  std::string out;
  for (auto row = rows.begin(); row != rows.end();) {
    const Contest& contest = row->contest;
    out += fmt::format("<details><summary>{} · {}, compared with <code>{}</code></summary>\n",
                       escaped(contest.scenario), to_string(contest.kind), escaped(contest.against)) +
           html::table_head(columns, 2);
    for (; row != rows.end() && one_section(row->contest, contest); ++row) out += row_html(*row);
    out += "</tbody></table></div></details>\n";
  }
  return out;
}

}  // namespace

std::string differences_html(const std::vector<MetricComparison>& rows) {
  if (rows.empty()) return "<p>No method can be compared with a baseline.</p>\n";
  return fmt::format(
             "<p>Each method is compared with the baseline of its task on the same simulated runs. The tables show the "
             "median of the paired differences with its 95 % bootstrap interval (BCa). They also show the number of "
             "runs on which the method was better and worse. The last column is the p-value of the signed-rank test, "
             "with Holm’s correction for the {} comparisons of this page. A failed run ranks as the worst.</p>\n",
             rows.size()) +
         folded_tables(rows, {"metric", "method", "simulated runs", "median", "baseline", "median difference [95 %]",
                              "better : worse", "p (Holm)", "finding", "more runs needed"});
}

std::string paired_failures_html(const std::vector<FailureComparison>& rows) {
  std::vector<FailureComparison> failed;
  for (const FailureComparison& row : rows) {
    if (row.share.value > 0.0 || row.against_share.value > 0.0) failed.push_back(row);
  }
  if (failed.empty()) return "";
  return "<p>The table shows the shares of simulated runs with a failed method run (status other than <i>ok</i>) or a "
         "negative verdict, with 95 % intervals (Clopper–Pearson). Further columns count the simulated runs on which "
         "only the method failed, and on which only the baseline failed. The last column shows McNemar’s paired test "
         "with Holm’s correction. The table leaves out pairs of methods without a failure.</p>\n" +
         folded_tables(failed, {"failure", "method", "simulated runs", "share [95 %]", "baseline [95 %]",
                                "method alone", "baseline alone", "p (Holm)", "finding"});
}

}  // namespace tumble::tools
