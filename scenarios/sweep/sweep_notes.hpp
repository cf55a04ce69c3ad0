// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Notes that a sweep leaves in its results (Results::set_note).
namespace tumble::scenarios {

/// The note `source` of results that were made of recordings: their draws cannot be simulated again.
inline constexpr const char* kRecordingsSource = "recordings";

/// The note of how the sweep was asked for: suite, seeds and methods as words of its command line.
inline constexpr const char* kCommandNote = "command";

}  // namespace tumble::scenarios
