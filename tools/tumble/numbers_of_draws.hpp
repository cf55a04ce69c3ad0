// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>

#include "scenarios/summary/sensitivity.hpp"
#include "tools/tumble/session.hpp"

/// numbers_of_draws.hpp returns the values of the random parameters of the simulated runs in a results database, by
/// scenario.
namespace tumble::tools {

using NumbersByScenario = std::map<std::string, scenarios::NumbersOfDraws>;

/// Returns the random parameters of catalogue scenarios. Other scenarios are omitted with a note. The database must
/// come from the same models and catalogue.
NumbersByScenario numbers_of_catalogue(const Session& session, const scenarios::DataRoot& data,
                                       const scenarios::Summary& summary);

/// Returns the motion values of each simulated run, such as the peak rate.
NumbersByScenario numbers_of_motions(std::span<const scenarios::DrawValues> draws, const scenarios::Summary& summary);

}  // namespace tumble::tools
