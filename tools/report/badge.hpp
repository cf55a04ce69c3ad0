// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// Badge contains the texts of a badge, and the colour of the verdict.
struct Badge {
  enum class Colour { good, open, bad };
  std::string label, message;
  Colour colour = Colour::open;
};

/// Summarises a report as a badge: the suite and the number of contests won (best method against baseline). The badge
/// is good if all contests are won, and bad if the certificate fails or a contest is lost.
Badge badge_of(const PageContent& content);

/// Returns the badge as a self-contained SVG for documents or CI servers. Texts are embedded as data, never as markup.
std::string badge_svg(const Badge& badge);

}  // namespace tumble::tools
