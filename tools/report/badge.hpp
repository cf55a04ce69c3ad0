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

/// The badge is good if the best method wins all comparisons with the reference method, and bad if a simulation check
/// fails or a comparison is lost.
Badge badge_of(const PageContent& content);

std::string badge_svg(const Badge& badge);

}  // namespace tumble::tools
