// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

struct RunKey {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string kind, method;
  Setting setting = {};
};
RunKey key_of(const Outcome& outcome);

std::string description_note(const std::string& kind, const std::string& method);
std::string recording_note(const std::string& name);
bool is_place_note(const std::string& key);

/// Returns the command that repeats a run: `tumble run SCENARIO --seed N --method KIND/NAME`. If the run has a varied
/// parameter, the command contains `--vary KEY=VALUE`. The words of the command line are quoted for a POSIX shell; a
/// word in capitals replaces missing information.
std::string command_again(const RunKey& run, const std::map<std::string, std::string>& notes);

Setting setting_from(const std::string& text);

std::string to_text(const Setting& setting);

}  // namespace tumble::scenarios
