// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

/// In a suite, each recording counts as one simulated run, with the file's name as name of the scenario, and with seed
/// 1.
namespace tumble::scenarios {

inline constexpr std::uint64_t kRecordingSeed = 1;

struct RecordedDraw {
  std::string name;  ///< file name without extension
  std::filesystem::path path;
  Subject subject;
  std::string digest;      ///< digest of sensors and truth
  bool simulated = false;  ///< has the truth that oracles need
  bool has_truth = false;
};

/// Finds the recordings whose paths match the patterns. A pattern has the syntax of glob(7), and a relative pattern
/// starts in `folder`.
std::vector<RecordedDraw> find_recordings(std::span<const std::string> patterns, const std::filesystem::path& folder);

std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const RecordedDraw& recording);

SimulatedDraw read_draw(const RecordedDraw& recording);

}  // namespace tumble::scenarios
