// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/keep.hpp"
#include "scenarios/sweep/unfinished_folder.hpp"

/// What the process of a draw leaves on the disk of it.
namespace tumble::scenarios {

/// The file with the command that makes a kept draw again.
inline constexpr const char* kDrawCommand = "command";

/// Whether and where the process of a draw keeps it.
struct Keeping {
  enum class When { never, if_failed, always };
  When when = When::never;
  std::filesystem::path folder;  ///< of the draw: FOLDER/SCENARIO/SEED
  std::string command;           ///< that makes it again
  RecordingInfo versions;        ///< of the program and the engine: what a recording says of itself beyond its draw
  bool lidars = false;           ///< whether a method of the draw reads lidars, be it run with this task or not
};

/// A draw that is kept, in the making. What it cannot write is trouble of the keeping alone: the draw goes on.
class DrawFiles {
 public:
  explicit DrawFiles(const Keeping& keeping);

  /// Where a method is to leave its estimate; empty where it need not.
  std::filesystem::path estimate(const MethodInfo& method);
  /// Writes the recording and moves all of it to its place, or removes it. What other methods have left there of the
  /// same sensors stays.
  void finish(const SimulatedDraw& draw, bool failed);
  /// An estimate could not be written.
  void miss(const std::string& why) { trouble_ = why; }
  /// What went wrong, one line; empty where nothing did.
  const std::string& trouble() const { return trouble_; }

 private:
  void take_over(const sim::Sensors& sensors) const;

  const Keeping& keeping_;
  std::optional<UnfinishedFolder> folder_;
  std::set<std::filesystem::path> asked_;  ///< names of the folders of estimates that are to be made
  std::string trouble_;
};

}  // namespace tumble::scenarios
