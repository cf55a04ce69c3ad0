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

Figure curve_figure(const Curve& curve, const Palette& palette = {});
std::string curves_html(std::span<const Curve> curves, std::vector<Figure>& figures, const Palette& palette = {});
Table curve_table(const Curve& curve);
nlohmann::json curves_json(std::span<const Curve> curves);

}  // namespace tumble::tools
