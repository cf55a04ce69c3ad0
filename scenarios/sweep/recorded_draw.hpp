// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

/// The functions in recorded_draw.hpp handle the recordings in a suite. Each recording counts as one simulated run,
/// with the file's name as scenario and seed 1.
namespace tumble::scenarios {

inline constexpr std::uint64_t kRecordingSeed = 1;

/// RecordedDraw describes a recording file in a suite.
struct RecordedDraw {
  std::string name;  ///< file name without extension
  std::filesystem::path path;
  Subject subject;
  std::string digest;      ///< digest of sensors and truth
  bool simulated = false;  ///< simulated recordings have the truth that oracles need
  bool has_truth = false;
};

/// Finds the recordings that match the file patterns, each recording once, sorted by name. A pattern has the syntax of
/// glob(7) and is relative to `folder` unless absolute. Throws BadInput for a pattern without a match, for two files
/// with the same name, and for unreadable files.
std::vector<RecordedDraw> find_recordings(std::span<const std::string> patterns, const std::filesystem::path& folder);

/// Returns the methods that can run on a recording, in the order of `methods`. The recording must have the sensors and,
/// if known, the robot that the method needs. Methods that need the truth need a simulated recording.
std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const RecordedDraw& recording);

/// Reads a recording in the form of a simulated run. Throws BadInput if the digest of the recording has changed since
/// the call of find_recordings.
SimulatedDraw read_draw(const RecordedDraw& recording);

}  // namespace tumble::scenarios
