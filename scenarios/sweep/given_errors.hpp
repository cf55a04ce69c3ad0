// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/sweep/evaluate.hpp"

namespace tumble::scenarios {

/// An error of stated size in what a method is given; the motion and what the sensors went through stay as they were,
/// so one simulation serves every size. One line of registration each (given_errors.cpp).
struct GivenError {
  sim::Parameter parameter;  ///< the size: name, unit, bounds, what it does; the default is no error
  bool needs_lidar = false;
  /// Puts the error into `sensors`, which belong to `truth` and `situation`. Its direction, if it has one, is drawn
  /// from the situation's seed: the same for every size.
  void (*put_in)(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation,
                 double size) = nullptr;
  /// What the same error makes of a method's parameters; null: nothing.
  void (*tune)(std::span<const sim::Parameter> known, double size, sim::Values& given) = nullptr;
};

std::span<const GivenError> given_errors();

/// Null when none is called `name`.
const GivenError* find_given_error(const std::string& name);

}  // namespace tumble::scenarios
