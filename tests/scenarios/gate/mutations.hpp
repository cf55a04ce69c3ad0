// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

/// Faults that somebody might build into a method by mistake, as methods of their own: the true one with something done
/// to what it is given, or to what it returns. The gate has to refuse each.
namespace tumble::scenarios::testing {

/// One line of registration each; at least one of `given` and `returned`.
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
