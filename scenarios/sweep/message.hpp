// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// Message is one report of a worker process to the main process. Exactly one member of a Message is set.
struct Message {
  std::optional<Outcome> outcome;
  std::optional<RejectedDraw> rejected;
  std::optional<DrawValues> draw = std::nullopt;
  std::optional<std::string> not_kept = std::nullopt;  ///< why files were not kept
};

/// Converts a message to one line of text. from_line() restores finite numbers bit-exactly, and converts all other
/// numbers to NaN.
std::string to_line(const Message& message);

std::optional<Message> from_line(const std::string& line);

}  // namespace tumble::scenarios
