// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// At most one member of a message is set; a message without members means that the run is complete.
struct Message {
  std::optional<Outcome> outcome;
  std::optional<RejectedDraw> rejected;
  std::optional<DrawValues> draw = std::nullopt;
  std::optional<std::string> not_kept = std::nullopt;  ///< why files were not kept
  bool is_last() const { return !outcome && !rejected && !draw && !not_kept; }
};

/// The function from_line() restores finite numbers bit-exactly; other numbers become NaN.
std::string to_line(const Message& message);

std::optional<Message> from_line(const std::string& line);

nlohmann::json to_json(const Setting& setting);
Setting setting_from(const nlohmann::json& pair);

}  // namespace tumble::scenarios
