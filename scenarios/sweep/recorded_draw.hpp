// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

/// Recordings in a suite: each is one draw, whose scenario is called as the file is and whose seed is 1.
namespace tumble::scenarios {

inline constexpr std::uint64_t kRecordingSeed = 1;

/// A recording file of a suite.
struct RecordedDraw {
  std::string name;  ///< of the file, without its ending
  std::filesystem::path path;
  Subject subject;
  std::string digest;      ///< of sensors and truth
  bool simulated = false;  ///< its truth is a simulation's, and so is all that oracles ask for
  bool has_truth = false;
};

/// The recordings that the patterns (of glob(7), relative to `folder` unless absolute) name, each once, in the order of
/// their names. Throws BadInput: a pattern without a file, two files of one name, what the readers say of a file.
std::vector<RecordedDraw> find_recordings(std::span<const std::string> patterns, const std::filesystem::path& folder);

/// The methods, in the order given, that can run on a recording: made for its robot, where that is known, with the
/// sensors that it has; oracles on simulations alone.
std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const RecordedDraw& recording);

/// The recording as a draw. Throws BadInput when it is not the one that was found (its digest has changed).
SimulatedDraw read_draw(const RecordedDraw& recording);

}  // namespace tumble::scenarios
