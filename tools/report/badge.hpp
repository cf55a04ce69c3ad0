// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

struct Badge {
  enum class Colour { good, open, bad };
  std::string label, message;
  Colour colour = Colour::open;
};

/// The badge is good if all contests (best method against baseline) are won, and bad if the certificate fails or a
/// contest is lost.
Badge badge_of(const PageContent& content);

/// Texts in the SVG are embedded as data, never as markup.
std::string badge_svg(const Badge& badge);

}  // namespace tumble::tools
