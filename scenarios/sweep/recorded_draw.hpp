// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

/// recorded_draw.hpp handles the recordings in a suite. Each recording counts as one simulated run, with the file's
/// name as scenario and with seed 1.
namespace tumble::scenarios {

inline constexpr std::uint64_t kRecordingSeed = 1;

/// RecordedDraw describes a recording file in a suite.
struct RecordedDraw {
  std::string name;  ///< file name without extension
  std::filesystem::path path;
  Subject subject;
  std::string digest;      ///< digest of sensors and truth
  bool simulated = false;  ///< a simulated recording has the truth that oracles need
  bool has_truth = false;
};

/// Finds the recordings that match the file patterns, each once, sorted by name. A pattern has the syntax of glob(7); a
/// relative pattern starts in `folder`. Throws BadInput for a pattern without a match, two files with the same name, or
/// an unreadable file.
std::vector<RecordedDraw> find_recordings(std::span<const std::string> patterns, const std::filesystem::path& folder);

/// Returns the methods that can process a recording, in the order of `methods`. The recording must have the sensors
/// that a method needs, and its robot if known. Methods that need the truth need a simulated recording.
std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const RecordedDraw& recording);

/// Reads a recording as a simulated run. Throws BadInput if its digest has changed since find_recordings.
SimulatedDraw read_draw(const RecordedDraw& recording);

}  // namespace tumble::scenarios
