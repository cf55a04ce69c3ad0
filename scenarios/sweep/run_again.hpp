// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

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
/// parameter, the command also contains `--vary KEY=VALUE`. The returned command is quoted for a POSIX shell. If the
/// recording's path is unknown, the command contains the placeholder FOLDER.
std::string command_again(const RunKey& run, const std::map<std::string, std::string>& notes);

Setting setting_from(const std::string& text);

std::string to_text(const Setting& setting);

/// Value of the note `source` in a results database whose results come from recordings, which cannot be simulated
/// again.
inline constexpr const char* kRecordingsSource = "recordings";

/// Value of the note `build` in a results database that merges results of several builds. Only reports accept merged
/// results.
inline constexpr const char* kMixedBuilds = "mixed";

/// Key of the note in the results database that contains the commands which produced the results. The note has one line
/// per call of `tumble sweep`, quoted for a shell.
inline constexpr const char* kCommandNote = "command";

std::vector<std::string> commands_of(const std::string& note);

std::string with_commands(const std::string& note, const std::string& more);

std::string shell_word(const std::string& text);

}  // namespace tumble::scenarios
