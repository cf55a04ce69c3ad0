// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/processes/process.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/sweep/sweep_plan.hpp"

namespace tumble::scenarios {

/// What a worker is made with.
struct WorkerTerms {
  const DataRoot& data;
  const SweepPlan& plan;
  double timeout_s;                ///< of a method
  double memory_mib;               ///< of data, of the worker and of each process that it makes
  bool recordings_unseen = false;  ///< as in SweepOptions
};

/// A process that serves one draw after the other. What it is told and what it says are lines of text, so that nothing
/// of a draw is there at the next. It is not used again after a draw on which a process came to no end of its own, nor
/// after `kDrawsPerWorker` draws.
class DrawWorker {
 public:
  static constexpr int kDrawsPerWorker = 200;

  /// Throws std::system_error when no process can be made.
  explicit DrawWorker(const WorkerTerms& terms);

  /// Hands it a draw, of which it has to be done by `deadline_s` (of now_s()). False when it has died while it was
  /// idle.
  bool give(const DrawTask& task, double deadline_s);

  bool is_busy() const { return busy_; }
  bool is_late() const { return busy_ && now_s() > deadline_s_; }
  /// Whether it may serve one more.
  bool is_fresh() const { return !busy_ && !spoilt_ && served_ < kDrawsPerWorker; }
  int read_end() const { return process_.read_end(); }
  /// The draw that it is at, less the runs that it has answered.
  const DrawTask& draw() const { return draw_; }

  /// Adds what it has said since; with its last word on a draw it is idle. False when it has ended.
  bool hear(std::vector<Message>& said);
  void kill() { process_.kill(); }
  /// Its end, waited for; one that is idle is told to come to it.
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
