// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/keep.hpp"

namespace tumble::scenarios {

inline constexpr const char* kUnfinished = ".unfinished";

/// UnfinishedFolder is an incomplete folder, WITHIN/.unfinished/NAME. The destructor removes the incomplete folder,
/// unless move_into_place() has moved the folder to the final path.
class UnfinishedFolder {
 public:
  UnfinishedFolder(const std::filesystem::path& place, const std::filesystem::path& within);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void move_into_place();

 private:
  std::filesystem::path place_, path_;
  bool moved_ = false;
};

inline constexpr const char* kDrawCommand = "command";

struct Keeping {
  enum class When { never, if_failed, always };
  When when = When::never;
  std::filesystem::path folder;  ///< FOLDER/SCENARIO/SEED
  std::string command;           ///< command that reproduces the run
  RecordingInfo versions;        ///< for the recording's metadata
  bool lidars = false;           ///< a method of the run reads lidars
};

class DrawFiles {
 public:
  explicit DrawFiles(const Keeping& keeping);

  std::filesystem::path estimate(const MethodInfo& method);
  void finish(const SimulatedDraw& draw, bool failed);
  void miss(const std::string& why) { trouble_ = why; }
  const std::string& error_code() const { return trouble_; }

 private:
  void take_over(const sim::Sensors& sensors) const;

  const Keeping& keeping_;
  std::optional<UnfinishedFolder> folder_;
  std::set<std::filesystem::path> asked_;  ///< folder names of the estimates in this run
  std::string trouble_;
};

}  // namespace tumble::scenarios
