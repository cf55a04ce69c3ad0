// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/estimates/method.hpp"
#include "tests/testing.hpp"

/// A mutation is a fault that somebody might build into a method by mistake: the method runs with a changed input or
/// returns a changed result. The gate must reject each mutation.
namespace tumble::scenarios::testing {

/// A Mutation has at least one of `given` and `returned`. Names are unique per scenario and method.
struct Mutation {
  std::string name;
  std::string scenario;
  std::string method;                                           ///< for example "slam/tumble"
  std::vector<std::string> metrics;                             ///< the gate must reject the row of each metric
  void (*given)(sim::Sensors& sensors);                         ///< changes the input; null: unchanged
  void (*returned)(const sim::Recording&, Estimate& estimate);  ///< changes the output; null: unchanged
};

std::span<const Mutation> mutations();

}  // namespace tumble::scenarios::testing
