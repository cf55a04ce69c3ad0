// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Notes that a sweep leaves in its results (Results::set_note).
namespace tumble::scenarios {

/// The note `source` of results that were made of recordings: their draws cannot be simulated again.
inline constexpr const char* kRecordingsSource = "recordings";

/// The note `build` of results that were merged of several builds (report-only databases).
inline constexpr const char* kMixedBuilds = "mixed";

/// The note of how the results were asked for: suite, seeds and methods as words of a command line, quoted for a shell;
/// a line for each sweep that left rows, in their order.
inline constexpr const char* kCommandNote = "command";

/// The lines of `note`, none of them empty.
std::vector<std::string> commands_of(const std::string& note);

/// `note` with those lines of `more` that it has not, behind its own.
std::string with_commands(const std::string& note, const std::string& more);

/// `text` as one word of a POSIX shell: quoted where it holds anything but letters, digits and `_-./:=,+@%`.
std::string shell_word(const std::string& text);

}  // namespace tumble::scenarios
