// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

/// Faults that a developer might add to a method by mistake. Each mutation is the true method with changed input or
/// changed output. The gate must reject each mutation.
namespace tumble::scenarios::testing {

/// Each mutation is one line of registration, with at least one of `given` and `returned`.
struct Mutation {
  const char* name;
  const char* scenario;
  const char* method;                                           ///< for example "slam/tumble"
  std::vector<std::string> metrics;                             ///< the gate must reject the row of each metric
  void (*given)(sim::Sensors& sensors);                         ///< changes the input; null: unchanged
  void (*returned)(const sim::Recording&, Estimate& estimate);  ///< changes the output; null: unchanged
};

std::span<const Mutation> mutations();

}  // namespace tumble::scenarios::testing
