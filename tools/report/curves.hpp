// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/curves.hpp"
#include "tools/report/plots.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

using scenarios::Curve;
using scenarios::CurveLine;
using scenarios::CurvePoint;

/// Returns one figure per curve. The upper plot shows the median, the band between the quartiles and the worst 5 %
/// (dotted). The lower plot shows the fraction of failures.
Figure curve_figure(const Curve& curve, const Palette& palette = {});
std::string curves_html(std::span<const Curve> curves, std::vector<Figure>& figures, const Palette& palette = {});
/// Returns a table with one row per method and point of the curve, in SI units.
Table curve_table(const Curve& curve);
nlohmann::json curves_json(std::span<const Curve> curves);

}  // namespace tumble::tools
