// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/processes/process.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/sweep/sweep_plan.hpp"

namespace tumble::scenarios {

struct WorkerTerms {
  const DataRoot& data;
  const SweepPlan& plan;
  double timeout_s;                ///< time limit of a method
  double memory_mib;               ///< of the worker and its children
  bool recordings_unseen = false;  ///< see SweepOptions
  std::filesystem::path temporary = {};
};

/// The worker ends after `kDrawsPerWorker` runs, or after a run in which a child process ended abnormally.
class DrawWorker {
 public:
  static constexpr int kDrawsPerWorker = 200;

  explicit DrawWorker(const WorkerTerms& terms);

  bool give(const DrawTask& task, double deadline_s);

  bool is_busy() const { return busy_; }
  bool is_late() const { return busy_ && now_s() > deadline_s_; }
  bool is_fresh() const { return !busy_ && !spoilt_ && served_ < kDrawsPerWorker; }
  int read_end() const { return process_.read_end(); }
  const DrawTask& draw() const { return draw_; }

  bool hear(std::vector<Message>& said);
  void kill() { process_.kill(); }
  Process::End dismiss();

 private:
  void take_up(const Message& message);

  const SweepPlan& plan_;
  Process process_;
  DrawTask draw_;
  std::string buffer_;
  double deadline_s_ = 0.0;
  int served_ = 0;
  bool busy_ = false, spoilt_ = false;
};

}  // namespace tumble::scenarios
