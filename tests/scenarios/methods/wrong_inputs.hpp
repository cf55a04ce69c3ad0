// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios::testing {

/// Typical faults of recordings from other sources, by name: units, axes, signs, clocks, mountings, failing sensors,
/// dust. `none` changes nothing.
const std::map<std::string, std::function<void(sim::Sensors&)>>& wrong_inputs();

/// Returns whether a wrong input affects data that methods of a kind (slam, position) use.
bool is_of_kind(const std::string& wrong_input, Kind kind);

}  // namespace tumble::scenarios::testing
