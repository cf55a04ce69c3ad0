// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// What a worker tells the sweep of the draw that it is at, one JSON object a line. At most one field is set; none: the
/// draw is done.
struct Message {
  std::optional<Outcome> outcome;
  std::optional<RejectedDraw> rejected;
  std::optional<DrawValues> draw = std::nullopt;
  std::optional<std::string> not_kept = std::nullopt;  ///< why the draw's files could not be kept
  /// Whether it is the last of its draw.
  bool is_last() const { return !outcome && !rejected && !draw && !not_kept; }
};

/// With the newline. Numbers come back to the bit; what is not finite comes back as NaN.
std::string to_line(const Message& message);

/// Without the newline. Nothing when the line is no message (a process that died in the middle of it).
std::optional<Message> from_line(const std::string& line);

}  // namespace tumble::scenarios
