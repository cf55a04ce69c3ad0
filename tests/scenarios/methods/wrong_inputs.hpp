// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios::testing {

/// Returns the faults that foreign recordings have: units, axes, signs, clocks, mountings, failing sensors and dust.
/// The faults are listed by name; `none` changes nothing.
const std::map<std::string, std::function<void(sim::Sensors&)>>& wrong_inputs();

/// Returns whether a wrong input belongs to the sensors that methods of a kind (slam, position) read.
bool is_of_kind(const std::string& wrong_input, Kind kind);

}  // namespace tumble::scenarios::testing
