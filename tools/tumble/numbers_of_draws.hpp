// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>

#include "scenarios/summary/sensitivity.hpp"
#include "tools/tumble/session.hpp"

/// What the draws of a results database differ in, scenario by scenario.
namespace tumble::tools {

using NumbersByScenario = std::map<std::string, scenarios::NumbersOfDraws>;

/// The numbers that were drawn, of the scenarios of the catalogue; others are told and left out. The database must have
/// been made of these data.
NumbersByScenario numbers_of_catalogue(const Session& session, const scenarios::DataRoot& data,
                                       const scenarios::Summary& summary);

/// What the motions were like.
NumbersByScenario numbers_of_motions(std::span<const scenarios::DrawValues> draws, const scenarios::Summary& summary);

}  // namespace tumble::tools
