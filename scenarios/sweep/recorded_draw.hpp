// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

/// recorded_draw.hpp handles recordings in a suite. Each recording counts as one simulated run, with the file's name as
/// scenario and seed 1.
namespace tumble::scenarios {

inline constexpr std::uint64_t kRecordingSeed = 1;

/// RecordedDraw is a recording file of a suite.
struct RecordedDraw {
  std::string name;  ///< file name without extension
  std::filesystem::path path;
  Subject subject;
  std::string digest;      ///< digest of sensors and truth
  bool simulated = false;  ///< simulated recordings have the truth that oracles need
  bool has_truth = false;
};

/// Returns the recordings that match the patterns, each recording once, sorted by name. Patterns have the syntax of
/// glob(7) and are relative to `folder` unless absolute. Throws BadInput for a pattern without a match, two files with
/// one name, and unreadable files.
std::vector<RecordedDraw> find_recordings(std::span<const std::string> patterns, const std::filesystem::path& folder);

/// Returns the methods that can run on a recording, in the order of `methods`. A method must apply to the recording's
/// sensors and, if known, its robot. Oracles need a simulated recording.
std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const RecordedDraw& recording);

/// Reads a recording in the form of a simulated run. Throws BadInput if the recording's digest has changed since the
/// call of find_recordings.
SimulatedDraw read_draw(const RecordedDraw& recording);

}  // namespace tumble::scenarios
