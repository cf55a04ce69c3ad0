// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tumble::scenarios {

/// Value of the note `source` if the results come from recordings, which cannot be simulated again
inline constexpr const char* kRecordingsSource = "recordings";

/// Value of the note `build` if results of several builds were merged; only reports accept such results
inline constexpr const char* kMixedBuilds = "mixed";

/// Key of the note with the commands that produced the results: one line per sweep, quoted for a shell
inline constexpr const char* kCommandNote = "command";

std::vector<std::string> commands_of(const std::string& note);

std::string with_commands(const std::string& note, const std::string& more);

std::string shell_word(const std::string& text);

}  // namespace tumble::scenarios
