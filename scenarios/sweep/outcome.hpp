// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {

/// Setting is one value of a parameter that a suite varies, either of a scenario or of a method. With an empty key,
/// scenario and methods are unmodified.
struct Setting {
  std::string key;
  double value = 0.0;
  bool is_plain() const { return key.empty(); }
  // NOLINTNEXTLINE(modernize-use-nullptr): false positive of clang-tidy 14 for a defaulted operator<=>
  auto operator<=>(const Setting&) const = default;
};

struct Outcome {
  std::string scenario;
  std::uint64_t seed = 0;
  Kind kind = Kind::rate;
  std::string method;
  OutcomeStatus status = OutcomeStatus::failed;
  std::string message;  ///< reason if not ok
  std::vector<Score> scores;
  std::string recording_digest;
  std::string estimate_digest;  ///< 32 hexadecimal digits
  Setting setting = {};
};

/// DrawValues contains motion values of one simulated run, for example the peak rate, which do not depend on the
/// methods.
struct DrawValues {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<Score> values;
  Setting setting = {};
};

bool was_scored(OutcomeStatus status);

/// Returns true if `status` has a higher rank than `other`. Completed runs have the highest rank, then `crashed` and
/// `timeout`, then `killed`.
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
