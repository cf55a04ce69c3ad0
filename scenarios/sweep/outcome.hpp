// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {

/// Setting is one value of a parameter that a suite varies for a curve; an empty key means an unmodified scenario and
/// unmodified methods.
struct Setting {
  std::string key;
  double value = 0.0;
  bool is_plain() const { return key.empty(); }
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const Setting&) const = default;
};

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

/// Motion values of one simulated run, such as the peak rate, are independent of the methods.
struct DrawValues {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<Score> values;
  Setting setting = {};
};

bool was_scored(OutcomeStatus status);

/// The order is: a completed run (states most about the method), crashed and timeout, killed (least).
bool outranks(OutcomeStatus status, OutcomeStatus other);

bool may_run_again(OutcomeStatus status);

struct RejectedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string message;
  Setting setting = {};
};

std::string digest(const Estimate& estimate);

}  // namespace tumble::scenarios
