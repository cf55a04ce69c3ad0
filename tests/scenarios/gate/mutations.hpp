// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

/// A mutation is a fault that somebody might build into a method by mistake: the method runs with a changed input or
/// returns a changed result. The gate must reject each mutation.
namespace tumble::scenarios::testing {

/// A Mutation needs one line of registration and at least one of `given` and `returned`.
struct Mutation {
  const char* name;
  const char* scenario;
  const char* method;                                           ///< "slam/tumble"
  std::vector<std::string> metrics;                             ///< each of whose rows has to refuse it
  void (*given)(sim::Sensors& sensors);                         ///< null: as it is
  void (*returned)(const sim::Recording&, Estimate& estimate);  ///< null: as it is
};

std::span<const Mutation> mutations();

}  // namespace tumble::scenarios::testing
