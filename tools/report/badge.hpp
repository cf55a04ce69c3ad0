// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// What a badge says, and whether that is good.
struct Badge {
  enum class Colour { good, open, bad };
  std::string label, message;
  Colour colour = Colour::open;
};

/// Of a report: the suite, and how many contests the best methods win. Bad where the certificate fails or a contest is
/// lost, good where all are won.
Badge badge_of(const PageContent& content);

/// As a picture for a document or a server of CI, complete in itself; its texts are data, never markup.
std::string badge_svg(const Badge& badge);

}  // namespace tumble::tools
