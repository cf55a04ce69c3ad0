// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {

/// Setting is one value of a parameter that a suite varies for a curve (variation.hpp): key and value. An empty key
/// means an unmodified scenario and unmodified methods.
struct Setting {
  std::string key;
  double value = 0.0;
  bool is_plain() const { return key.empty(); }
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const Setting&) const = default;
};

/// Outcome is one row of the results: status and scores of one method on one simulated run.
struct Outcome {
  std::string scenario;
  std::uint64_t seed = 0;
  Kind kind = Kind::rate;
  std::string method;
  OutcomeStatus status = OutcomeStatus::failed;
  std::string message;  ///< reason in one line if the status is not ok
  std::vector<Score> scores;
  std::string recording_digest;
  std::string estimate_digest;  ///< digest of the estimate's numbers, 32 hexadecimal digits
  Setting setting = {};
};

/// DrawValues contains the motion values of one simulated run, such as the peak rate. Motion values are independent of
/// the methods (scenarios/scoring/motion_summary.hpp).
struct DrawValues {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<Score> values;
  Setting setting = {};
};

/// Returns true if the method completed: its status is ok, diverged or failed.
bool was_scored(OutcomeStatus status);

/// Returns true if `status` states more about the method than `other`. The order is: a completed run (most), crashed
/// and timeout, killed (least).
bool outranks(OutcomeStatus status, OutcomeStatus other);

/// Returns true if a sweep may repeat a method with this status: crashed, timeout or killed.
bool may_run_again(OutcomeStatus status);

/// RejectedDraw is a scenario with a seed whose simulation is impossible on any machine. In the database, it has an
/// empty kind and method. If instead a process dies, the status of its methods is crashed, timeout or killed.
struct RejectedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string message;
  Setting setting = {};
};

/// Returns a digest of all numbers of an estimate (XXH3, 128 bit), except costs and timings.
std::string digest(const Estimate& estimate);

}  // namespace tumble::scenarios
