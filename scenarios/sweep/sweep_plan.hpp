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

/// The draws of a suite one after the other, and what is to run on each; memory does not grow with their number. A
/// worker that was forked after it was made reads the lines that it writes of a task.
class SweepPlan {
 public:
  /// Throws BadInput: an unknown method, scenario or recording, a catalogue that cannot be drawn from, methods none of
  /// which applies.
  SweepPlan(const DataRoot& data, const Suite& suite, const SweepOptions& options,
            const std::filesystem::path& database);

  SweepPlan(const SweepPlan&) = delete;  // tasks point into it
  SweepPlan& operator=(const SweepPlan&) = delete;

  std::uint64_t draws_total() const;
  const std::vector<MethodPointer>& methods() const { return methods_; }
  /// Rows of a recording that has been imported anew do not stand beside those of the old one: throws BadInput.
  void require_same_recordings(const Results& results) const;
  /// Leaves where each recording lies, so that its runs can be asked for once more (run_again.hpp).
  void note_recordings(Results& results) const;

  /// Recordings come first, then seeds, which are outermost, so that a sweep that is stopped has all scenarios and all
  /// points of the curves in it.
  bool at_end() const { return next_.recording == recordings_.size() && next_.past_seeds; }
  void advance();
  /// The draw that comes next, with what has no row yet or one that is to be run again.
  DrawTask next(const Results& results) const;

  /// Whether it is a draw of the suite's scenarios, of whatever seed.
  bool has(const DrawName& draw) const;
  /// A draw that the suite `has`, once more with what has come to its end on it, to be kept.
  DrawTask again(const DrawName& draw, const Results& results) const;

  std::string to_line(const DrawTask& task) const;
  DrawTask from_line(const std::string& line) const;

 private:
  /// A scenario or a recording of the suite, and the methods that apply to it.
  struct Planned {
    std::string asked;  ///< as the suite has it
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

  /// Whether the draw that comes next is one of the suite's, where these are named one by one.
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
  /// Of the plain draw and of each one that a curve simulates anew; and what is run on the plain one besides.
  std::vector<Setting> simulated_ = {Setting{}}, shared_;
  std::vector<MethodPointer> methods_;
  std::vector<Planned> scenarios_;
  std::vector<Recorded> recordings_;
  Cursor next_;
};

}  // namespace tumble::scenarios
