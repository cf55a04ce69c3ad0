// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Notes that a sweep leaves in its results (Results::set_note).
namespace tumble::scenarios {

/// The note `source` of results that were made of recordings: their draws cannot be simulated again.
inline constexpr const char* kRecordingsSource = "recordings";

/// The note `build` of results that were merged of several builds (report-only databases).
inline constexpr const char* kMixedBuilds = "mixed";

/// The note of how the sweep was asked for: suite, seeds and methods as words of its command line, quoted for a shell.
inline constexpr const char* kCommandNote = "command";

/// `text` as one word of a POSIX shell: quoted where it holds anything but letters, digits and `_-./:=,+@%`.
std::string shell_word(const std::string& text);

}  // namespace tumble::scenarios
