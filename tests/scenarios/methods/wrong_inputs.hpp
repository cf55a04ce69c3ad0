// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios::testing {

/// What recordings are wrong in when somebody else made them: units, axes, signs, clocks, mountings, sensors that die,
/// dust. By name; `none` changes nothing.
const std::map<std::string, std::function<void(sim::Sensors&)>>& wrong_inputs();

/// Whether a wrong input is one of what methods of a kind (slam, position) read.
bool is_of_kind(const std::string& wrong_input, Kind kind);

}  // namespace tumble::scenarios::testing
