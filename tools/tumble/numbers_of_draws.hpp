// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>

#include "scenarios/summary/sensitivity.hpp"
#include "tools/tumble/session.hpp"

/// The functions in numbers_of_draws.hpp return the random numbers of the simulated runs in a results database, by
/// scenario.
namespace tumble::tools {

using NumbersByScenario = std::map<std::string, scenarios::NumbersOfDraws>;

/// Returns the random numbers of catalogue scenarios; other scenarios are omitted with a note. The database must have
/// been made with the same models and catalogue.
NumbersByScenario numbers_of_catalogue(const Session& session, const scenarios::DataRoot& data,
                                       const scenarios::Summary& summary);

/// Returns the motion values of each simulated run, such as the peak rate.
NumbersByScenario numbers_of_motions(std::span<const scenarios::DrawValues> draws, const scenarios::Summary& summary);

}  // namespace tumble::tools
