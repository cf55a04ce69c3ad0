// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/dependence_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/html/html.hpp"

namespace tumble::tools {

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
