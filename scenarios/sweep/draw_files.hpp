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

/// DrawFiles writes the files of a simulated run that a sweep keeps.
namespace tumble::scenarios {

/// Name of the file with the command that reproduces a kept run.
inline constexpr const char* kDrawCommand = "command";

/// Keeping states whether and where the files of a simulated run are kept.
struct Keeping {
  enum class When { never, if_failed, always };
  When when = When::never;
  std::filesystem::path folder;  ///< FOLDER/SCENARIO/SEED
  std::string command;           ///< command that reproduces the run
  RecordingInfo versions;        ///< versions of program and physics engine, for the metadata of the recording
  bool lidars = false;           ///< a method of the run reads lidars, in this or in another task
};

/// DrawFiles writes the recording and the estimates of a kept simulated run. A write error does not change the outcomes
/// of the run.
class DrawFiles {
 public:
  explicit DrawFiles(const Keeping& keeping);

  /// Returns the folder in which a method must write its estimate; empty if the estimate is not kept.
  std::filesystem::path estimate(const MethodInfo& method);
  /// Writes the recording and moves all files to their final folder. After `miss` or a write error, all files are
  /// removed instead. Stored estimates of other methods remain if their sensor data were equal.
  void finish(const SimulatedDraw& draw, bool failed);
  /// Records that an estimate could not be written.
  void miss(const std::string& why) { trouble_ = why; }
  /// Describes the error in one line; empty if there is no error.
  const std::string& error_code() const { return trouble_; }

 private:
  void take_over(const sim::Sensors& sensors) const;

  const Keeping& keeping_;
  std::optional<UnfinishedFolder> folder_;
  std::set<std::filesystem::path> asked_;  ///< folder names of the estimates in this run
  std::string trouble_;
};

}  // namespace tumble::scenarios
