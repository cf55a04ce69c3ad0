// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/draw/scenario.hpp"
#include "sim/situation.hpp"

namespace tumble::scenarios {

bool has_lidar(const Scenario& scenario);

sim::ResolvedSituation without_lidars(const sim::ResolvedSituation& situation);

}  // namespace tumble::scenarios
