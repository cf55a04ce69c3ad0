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

class SweepPlan {
 public:
  SweepPlan(const DataRoot& data, const Suite& suite, const SweepOptions& options,
            const std::filesystem::path& database);

  SweepPlan(const SweepPlan&) = delete;  // tasks point into the plan
  SweepPlan& operator=(const SweepPlan&) = delete;

  std::uint64_t draws_total() const;
  const std::vector<MethodPointer>& methods() const { return methods_; }
  void require_same_recordings(const Results& results) const;
  void note_recordings(Results& results) const;

  /// Returns true if all tasks of the plan are complete. The plan contains recordings first, and then the scenarios,
  /// with the seed as outer loop. Because of this order, a sweep that is stopped early still covers all scenarios and
  /// all values of varied parameters.
  bool at_end() const { return next_.recording == recordings_.size() && next_.past_seeds; }
  void advance();
  DrawTask next(const Results& results) const;

  bool has(const DrawName& draw) const;
  DrawTask again(const DrawName& draw, const Results& results) const;

 private:
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
  std::vector<Setting> simulated_ = {Setting{}}, shared_;
  std::vector<MethodPointer> methods_;
  std::vector<Planned> scenarios_;
  std::vector<Recorded> recordings_;
  Cursor next_;
};

}  // namespace tumble::scenarios
