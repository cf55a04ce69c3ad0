// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/score_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/html/html.hpp"

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

}  // namespace tumble::tools
