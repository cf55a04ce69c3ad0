// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// One member of a message is set.
struct Message {
  std::optional<Outcome> outcome;
  std::optional<RejectedDraw> rejected;
  std::optional<DrawValues> draw = std::nullopt;
  std::optional<std::string> not_kept = std::nullopt;  ///< why files were not kept
};

/// The function from_line() restores finite numbers bit-exactly; other numbers become NaN.
std::string to_line(const Message& message);

std::optional<Message> from_line(const std::string& line);

}  // namespace tumble::scenarios
