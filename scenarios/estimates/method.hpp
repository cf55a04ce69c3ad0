// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/estimate.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// OracleInput contains the true state and the readings before clipping. Only methods with `needs_truth` receive an
/// OracleInput.
struct OracleInput {
  const sim::Truth* truth = nullptr;
  /// A slam method calls on_sweep() after each lidar sweep, with the number of processed sweeps and the total number of
  /// sweeps.
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

class SettingsTable;

struct Subject {
  std::string robot;  ///< empty if unknown
  bool has_lidar = true;
};

struct MethodInfo {
  std::string name;
  Kind kind = Kind::rate;
  std::string doc = {};                             ///< description, in one sentence
  bool ours = false;                                ///< developed in this project
  std::string source = {};                          ///< paper, or "ours"
  std::vector<const SettingsTable*> settings = {};  ///< settings that define `parameters`
  std::span<const sim::Parameter> parameters = {};
  std::size_t parameters_first = 0;  ///< common ones come first in `parameters`
  bool needs_truth = false;
  std::vector<std::string> robots = {};  ///< "rig", "sphere"; empty: all
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// If true, the method is the baseline to which other methods of its kind are compared. A baseline does not handle
  /// saturation or slip.
  bool baseline = false;
  std::string version = {};  ///< for external methods
};

std::string full_name(const MethodInfo& info);

/// A method must return bit-identical results for equal inputs.
using RunMethod = std::function<Estimate(const sim::Sensors&, const sim::Values& parameters, const OracleInput&)>;

struct Method {
  MethodInfo info;
  RunMethod run;
};

using MethodPointer = std::shared_ptr<const Method>;

MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
