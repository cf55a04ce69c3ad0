// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {

/// The point of a curve that a row belongs to (variation.hpp): what was varied, and its value. Without a key: the
/// scenario and the methods as they are.
struct Setting {
  std::string key;
  double value = 0.0;
  bool is_plain() const { return key.empty(); }
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const Setting&) const = default;
};

/// One row of the results: what one method did on one draw.
struct Outcome {
  std::string scenario;
  std::uint64_t seed = 0;
  Kind kind = Kind::rate;
  std::string method;
  OutcomeStatus status = OutcomeStatus::failed;
  std::string message;  ///< one line when not ok
  std::vector<Score> scores;
  std::string recording_digest;
  std::string estimate_digest;  ///< of the estimate's numbers, 32 hexadecimal digits
  Setting setting = {};
};

/// What the motion of one draw was like, whatever the methods make of it (scenarios/scoring/motion_summary.hpp).
struct DrawValues {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<Score> values;
  Setting setting = {};
};

/// Of a method that came to its end: ok, diverged, failed.
bool was_scored(OutcomeStatus status);

/// Whether a status says more of the method than another: one that came to its end more than crashed and timeout, these
/// more than killed.
bool outranks(OutcomeStatus status, OutcomeStatus other);

/// Whether a sweep may be asked to run rows of this status once more: crashed, timeout, killed.
bool may_run_again(OutcomeStatus status);

/// A draw that cannot be drawn or simulated, whatever the machine: an outcome of its own, kind and method empty in the
/// database. A process that died over it is none: its methods are crashed, timeout or killed.
struct RejectedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string message;
  Setting setting = {};
};

/// Digest of all numbers of an estimate (XXH3, 128 bit), costs and health timings excluded.
std::string digest(const Estimate& estimate);

}  // namespace tumble::scenarios
