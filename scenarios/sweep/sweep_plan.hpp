// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/recorded_draw.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

namespace tumble::scenarios {

/// Iterates over the draws of a suite with the runs on each, in constant memory. Workers forked later can parse the
/// tasks that it writes as lines.
class SweepPlan {
 public:
  /// Throws BadInput: unknown method, scenario or recording, a catalogue that cannot be drawn from, or no method that
  /// applies.
  SweepPlan(const DataRoot& data, const Suite& suite, const SweepOptions& options,
            const std::filesystem::path& database);

  SweepPlan(const SweepPlan&) = delete;  // tasks point into it
  SweepPlan& operator=(const SweepPlan&) = delete;

  std::uint64_t draws_total() const;
  const std::vector<MethodPointer>& methods() const { return methods_; }
  /// Throws BadInput if the results contain rows of an older import of a recording.
  void require_same_recordings(const Results& results) const;
  /// Stores the paths of the recordings, so that their runs can be repeated (run_again.hpp).
  void note_recordings(Results& results) const;

  /// Recordings come first, then seeds as the outer loop, so that a stopped sweep covers all scenarios and curve
  /// points.
  bool at_end() const { return next_.recording == recordings_.size() && next_.past_seeds; }
  void advance();
  /// Returns the next draw with the runs that have no row yet or are to be repeated.
  DrawTask next(const Results& results) const;

  /// Returns true for a draw of the suite's scenarios, for any seed.
  bool has(const DrawName& draw) const;
  /// Returns a draw that the suite `has` with its completed runs, to be kept.
  DrawTask again(const DrawName& draw, const Results& results) const;

  std::string to_line(const DrawTask& task) const;
  DrawTask from_line(const std::string& line) const;

 private:
  /// A scenario or recording of the suite with the methods that apply.
  struct Planned {
    std::string asked;  ///< name in the suite
    Scenario scenario;
    std::vector<MethodPointer> methods;
  };
  struct Recorded {
    RecordedDraw recording;
    std::vector<MethodPointer> methods;
  };
  struct Cursor {
    std::size_t recording = 0;
    std::uint64_t seed = 0;
    std::size_t scenario = 0, setting = 0;
    bool past_seeds = false;
  };

  /// Returns true if the next draw is one of the suite's named draws, or none are named.
  bool is_wanted() const;
  void step();
  void add_missing(const std::vector<MethodPointer>& methods, const std::vector<Outcome>& held, const Setting& setting,
                   DrawTask& task) const;
  DrawTask of_recording(const Results& results) const;
  DrawTask of_scenario(const Results& results) const;
  Keeping keeping(const Planned& planned, const DrawTask& task, Keeping::When when) const;
  bool read_lidars(const Planned& planned, const std::vector<Outcome>& held) const;

  const Suite& suite_;
  const SweepOptions& options_;
  KeptDraws kept_;
  /// settings that need their own simulation, and those that reuse the plain one
  std::vector<Setting> simulated_ = {Setting{}}, shared_;
  std::vector<MethodPointer> methods_;
  std::vector<Planned> scenarios_;
  std::vector<Recorded> recordings_;
  Cursor next_;
};

}  // namespace tumble::scenarios
