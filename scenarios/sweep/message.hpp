// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// Message is a message from a worker about its current simulated run: one line with a JSON object. At most one member
/// is set. If no member is set, the run is complete.
struct Message {
  std::optional<Outcome> outcome;
  std::optional<RejectedDraw> rejected;
  std::optional<DrawValues> draw = std::nullopt;
  std::optional<std::string> not_kept = std::nullopt;  ///< reason why files of the run could not be kept
  /// Returns true for the last message of a simulated run.
  bool is_last() const { return !outcome && !rejected && !draw && !not_kept; }
};

/// Converts the message to one line with a newline. Finite numbers are restored bit-exactly by from_line; others become
/// NaN.
std::string to_line(const Message& message);

/// Parses one line without its newline; empty if the line is incomplete, because the process died while writing.
std::optional<Message> from_line(const std::string& line);

}  // namespace tumble::scenarios
