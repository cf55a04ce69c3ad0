// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/badge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/html/html.hpp"
#include "tools/report/contests.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

namespace {

constexpr int kHeight_px = 20, kPad_px = 7;

int width_px(const std::string& text) {
  return static_cast<int>(std::lround(6.6 * static_cast<double>(character_count(text))));
}

const char* fill(Badge::Colour colour) {
  switch (colour) {
    case Badge::Colour::good:
      return "#0b6e56";
    case Badge::Colour::bad:
      return "#b23a12";
    case Badge::Colour::open:
      break;
  }
  return "#5d676e";
}

std::string text_svg(const std::string& text, int x_px) {
  return fmt::format("<text x=\"{}\" y=\"14\" textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\">{}</text>", x_px,
                     width_px(text), html::escaped(text));
}

}  // namespace

Badge badge_of(const PageContent& content) {
  const Tally counts = tally(contests(content.summary, content.comparison));
  const bool sound = std::all_of(content.certificates.begin(), content.certificates.end(),
                                 [](const scenarios::Certificate& certificate) { return certificate.passes(); });
  Badge badge;
  badge.label = content.title;
  if (!sound) {
    badge.message = "certificate failed";
    badge.colour = Badge::Colour::bad;
  } else if (counts.contests == 0) {
    badge.message = "no methods to compare";
  } else {
    badge.message = fmt::format("better than the baseline in {} of {}", counts.won, counts.contests);
    if (counts.lost > 0) badge.message += fmt::format(", {} worse", counts.lost);
    if (counts.lost > 0) badge.colour = Badge::Colour::bad;
    if (counts.won == counts.contests) badge.colour = Badge::Colour::good;
  }
  return badge;
}

std::string badge_svg(const Badge& badge) {
  const int label_px = width_px(badge.label) + 2 * kPad_px, message_px = width_px(badge.message) + 2 * kPad_px;
  const int width = label_px + message_px;
  const std::string whole = html::escaped(badge.label + ": " + badge.message);
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" role=\"img\" "
             "aria-label=\"{2}\"><title>{2}"
             "</title><rect width=\"{0}\" height=\"{1}\" rx=\"3\" fill=\"#1d2327\"/><path d=\"M{3} 0h{4}a3 3 0 0 1 3 "
             "3v14a3 3 0 0 1 "
             "-3 3h-{4}z\" fill=\"{5}\"/><g fill=\"#fff\" font-family=\"Verdana,DejaVu Sans,sans-serif\" "
             "font-size=\"11\">",
             width, kHeight_px, whole, label_px, message_px - 3, fill(badge.colour)) +
         text_svg(badge.label, kPad_px) + text_svg(badge.message, label_px + kPad_px) + "</g></svg>\n";
}

}  // namespace tumble::tools
