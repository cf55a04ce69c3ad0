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

/// The class DrawFiles writes the files of a simulated run that a sweep keeps.
namespace tumble::scenarios {

/// kDrawCommand is the name of the file with the command that reproduces a kept run.
inline constexpr const char* kDrawCommand = "command";

/// Keeping states whether and where the files of a simulated run are kept.
struct Keeping {
  enum class When { never, if_failed, always };
  When when = When::never;
  std::filesystem::path folder;  ///< FOLDER/SCENARIO/SEED
  std::string command;           ///< command that reproduces the run
  RecordingInfo versions;        ///< versions of the program and the engine, for the recording's metadata
  bool lidars = false;           ///< any method of the run reads lidars, in this or another task
};

/// DrawFiles writes the recording and the estimates of a simulated run that is kept. A write error does not change the
/// outcomes of the run.
class DrawFiles {
 public:
  explicit DrawFiles(const Keeping& keeping);

  /// Returns the folder in which a method must write its estimate, or an empty path if the estimate is not needed.
  std::filesystem::path estimate(const MethodInfo& method);
  /// Writes the recording and moves all files to their final folder. After `miss`, or if a file cannot be written, the
  /// function instead removes all files. Stored estimates of other methods remain if they were computed from equal
  /// sensor data.
  void finish(const SimulatedDraw& draw, bool failed);
  /// Records that an estimate could not be written.
  void miss(const std::string& why) { trouble_ = why; }
  /// Describes the error in one line, or returns an empty text without an error.
  const std::string& error_code() const { return trouble_; }

 private:
  void take_over(const sim::Sensors& sensors) const;

  const Keeping& keeping_;
  std::optional<UnfinishedFolder> folder_;
  std::set<std::filesystem::path> asked_;  ///< folder names of the requested estimates
  std::string trouble_;
};

}  // namespace tumble::scenarios
