// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/curves.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tumble::tools {

Table curve_table(const Curve& curve) {
  Table table(fmt::format("{}: {} against {}", curve.scenario, curve.metric, curve.axis),
              {"method", curve.axis, "draws", "failed", "at most (95 %)", "25 %", "median", "75 %", "worst 5 %"});
  table.align_right_from(1);
  for (const CurveLine& line : curve.lines) {
    bool first = true;
    for (const CurvePoint& point : line.points) {
      table.add_row({first ? line.method : "", point.label.empty() ? number_text(point.x) : point.label,
                     std::to_string(point.draws), std::to_string(point.failed),
                     fmt::format("{:.1f} %", 100.0 * point.failed_share.high), number_text(point.quantile_25),
                     number_text(point.median), number_text(point.quantile_75), number_text(point.worst_5)});
      first = false;
    }
  }
  return table;
}

nlohmann::json curves_json(std::span<const Curve> curves) {
  const auto finite = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); };
  nlohmann::json rows = nlohmann::json::array();
  constexpr std::array kSources = {"set", "samples", "draws"};
  for (const Curve& curve : curves) {
    for (const CurveLine& line : curve.lines) {
      for (const CurvePoint& point : line.points) {
        rows.push_back({{"source", kSources[static_cast<std::size_t>(curve.source)]},
                        {"axis", curve.axis},
                        {"scenario", curve.scenario},
                        {"kind", to_string(curve.kind)},
                        {"metric", curve.metric},
                        {"method", line.method},
                        {"x", finite(point.x)},
                        {"bin", point.label},
                        {"draws", point.draws},
                        {"failed", point.failed},
                        {"failed_share_high", finite(point.failed_share.high)},
                        {"quantile_25", finite(point.quantile_25)},
                        {"median", finite(point.median)},
                        {"quantile_75", finite(point.quantile_75)},
                        {"worst_5", finite(point.worst_5)}});
      }
    }
  }
  return rows;
}

}  // namespace tumble::tools
