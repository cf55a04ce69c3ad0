// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sensitivity_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/html/html.hpp"
#include "tools/report/score_html.hpp"

namespace tumble::tools {

namespace {

using html::cell;
using html::escaped;
using scenarios::Influence;
using scenarios::Sensitivity;

constexpr std::size_t kStrongest = 3;
constexpr const char* kFailure = "not ok";

std::string median_text(const Sensitivity& row, double value) {
  if (row.metric == kFailure) return value > 0.0 ? "failed" : "ok";
  return styled_value(row.metric, value, true);
}

std::string strength_cell(double strength) {
  return fmt::format("<td class=\"number\"><span class=\"strength\" style=\"width:{:.0f}px\"></span>{:.2f}</td>",
                     60.0 * strength, strength);
}

std::string dependence_cell(const Sensitivity& row, const Influence& each) {
  const bool is_share = row.metric == kFailure || scenarios::metric_info(row.metric).unit == scenarios::Unit::verdict;
  const auto label_of = [&](const scenarios::DependenceClass& part) {
    const std::string centre =
        is_share ? fmt::format("failures {:.0f} % [{:.0f}, {:.0f}]", 100.0 * part.centre.value, 100.0 * part.centre.low,
                               100.0 * part.centre.high)
                 : styled_value(row.metric, part.centre.value, true) + " " + styled_interval(row.metric, part.centre);
    return fmt::format("{} from {:.4g} to {:.4g}: {} in {} simulated runs", each.number, part.low, part.high, centre,
                       part.draws);
  };
  return "<td>" + dependence_svg(each.dependence, label_of) + "</td>";
}

std::string influence_cells(const Sensitivity& row, const Influence& each) {
  return "<td><code>" + escaped(each.number) + "</code></td>" + strength_cell(each.strength()) +
         dependence_cell(row, each) +
         cell(fmt::format("{:+.2f} [{:+.2f}, {:+.2f}]", each.correlation.rho, each.correlation.low,
                          each.correlation.high),
              "number") +
         cell(median_text(row, each.median_low), "number") + cell(median_text(row, each.median_high), "number");
}

std::string row_html(const Sensitivity& row) {
  std::string out;
  std::size_t shown = 0;
  for (const Influence& each : row.influences) {
    if (shown == kStrongest) break;
    if (!(each.corrected < scenarios::kInfluenceRisk)) continue;
    out += "<tr>" + cell(shown == 0 ? row.method : "") + cell(shown == 0 ? row.metric : "") +
           influence_cells(row, each) + "</tr>\n";
    ++shown;
  }
  if (shown > 0) return out;
  return "<tr>" + cell(row.method) + cell(row.metric) + "<td colspan=\"6\">no significant influence</td></tr>\n";
}

constexpr auto kDrawsMin = static_cast<std::int64_t>(scenarios::kSensitivityDrawsMin);
constexpr auto kDrawnFrom = static_cast<std::int64_t>(2 * scenarios::kDependenceDrawsMin);

}  // namespace

std::string draws_needed_text(const std::map<std::string, std::int64_t>& draws) {
  std::string out;
  for (const auto& [scenario, count] : draws) {
    if (count >= kDrawnFrom) continue;
    out += out.empty() ? fmt::format(
                             "A scenario needs {} simulated runs to compute the influence of its parameters. A plot of "
                             "the score against a parameter needs {} simulated runs. These scenarios need more runs: ",
                             kDrawsMin, kDrawnFrom)
                       : "; ";
    out += scenario + " ";
    if (count < kDrawsMin) out += fmt::format("{}, and ", kDrawsMin - count);
    out += fmt::format("{} for the plot", kDrawnFrom - count);
  }
  return out.empty() ? out : out + ". ";
}

std::string sensitivity_html(const std::vector<Sensitivity>& rows, const std::string& note) {
  std::string out;
  if (!note.empty()) out += "<p>" + escaped(note) + "</p>\n";
  if (rows.empty()) return out;
  out +=
      "<p>For each method and score, the table shows the three random parameters of the scenario with the strongest "
      "significant influence. Significant means a risk of 5 %, with Holm’s correction over all parameters. The "
      "strength is the share of the variance of the score’s ranks that the parameter explains. It is the larger of "
      "the parameter’s first-order index and squared rank correlation. The plot shows the score over the range of "
      "the parameter, in classes with equal numbers of runs. Each class shows the median (or the share of "
      "failures) with its 95 % interval. Point at a class to see its values. A correlation above 0 means that "
      "larger values of the parameter give worse scores. The last two columns show median scores: of the quarter of "
      "the runs with the lowest values, and of the quarter with the highest values.</p>\n";
  for (auto row = rows.begin(); row != rows.end();) {
    const Sensitivity& first = *row;
    out += fmt::format("<details{}><summary>{} · {}</summary>\n", row == rows.begin() ? " open" : "",
                       escaped(first.scenario), to_string(first.kind)) +
           html::table_head({"method", "score", "parameter", "strength", "score over its range",
                             "rank correlation [95 %]", "lowest quarter", "highest quarter"},
                            3);
    for (; row != rows.end() && row->scenario == first.scenario && row->kind == first.kind; ++row)
      out += row_html(*row);
    out += "</tbody></table></div></details>\n";
  }
  return out;
}

namespace {

using scenarios::DependenceClass;

constexpr double kWidth = 150.0, kHeight = 44.0, kPlotMargin = 3.0;
constexpr double kLeastWidth = 3.0;  // minimum width of a class
constexpr double kDecade = 10.0;

struct Axis {
  double low = 0.0, high = 0.0;        ///< values, or their logarithms
  double at_low = 0.0, at_high = 0.0;  ///< pixels
  bool logarithmic = false;

  double place(double value) const {
    const double scaled = logarithmic ? std::log10(value) : value;  // log10(0) is drawn on the frame
    const double share = high > low ? (scaled - low) / (high - low) : 0.5;
    return at_low + std::clamp(share, 0.0, 1.0) * (at_high - at_low);
  }
};

Axis height_axis(std::span<const DependenceClass> classes) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double least_centre = low, largest_centre = high;
  for (const DependenceClass& part : classes) {
    for (const double value : {part.centre.low, part.centre.value, part.centre.high}) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (!std::isfinite(part.centre.value)) continue;
    least_centre = std::min(least_centre, part.centre.value);
    largest_centre = std::max(largest_centre, part.centre.value);
  }
  Axis axis{low, high, kHeight - kPlotMargin, kPlotMargin, false};
  if (!(least_centre > 0.0) || !(largest_centre > kDecade * least_centre)) return axis;
  axis.logarithmic = true;
  axis.low = std::log10(low > 0.0 ? low : least_centre / kDecade);
  axis.high = std::log10(high);
  return axis;
}

}  // namespace

std::string dependence_svg(std::span<const DependenceClass> classes,
                           const std::function<std::string(const DependenceClass&)>& label_of) {
  const auto is_finite = [](const DependenceClass& part) { return std::isfinite(part.centre.value); };
  if (classes.size() < 2 || std::none_of(classes.begin(), classes.end(), is_finite)) return "";
  const Axis along{classes.front().low, classes.back().high, kPlotMargin, kWidth - kPlotMargin, false};
  const Axis up = height_axis(classes);
  std::string out = fmt::format(
      "<svg class=\"dependence\" role=\"img\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\">",
      kWidth, kHeight);
  for (const DependenceClass& part : classes) {
    const double from = std::min(along.place(part.low), kWidth - kPlotMargin - kLeastWidth);
    const double width = std::max(along.place(part.high) - from, kLeastWidth);
    const double top = up.place(part.centre.high), bottom = up.place(part.centre.low);
    out += fmt::format(
        "<g><title>{}</title><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>"
        "<path d=\"M{:.1f} {:.1f}h{:.1f}\"/></g>",
        html::escaped(label_of(part)), from, top, width, std::max(bottom - top, 1.0), from, up.place(part.centre.value),
        width);
  }
  return out + "</svg>";
}

}  // namespace tumble::tools
