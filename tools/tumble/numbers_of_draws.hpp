// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>

#include "scenarios/summary/sensitivity.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

using NumbersByScenario = std::map<std::string, scenarios::NumbersOfDraws>;

NumbersByScenario numbers_of_catalogue(const Session& session, const scenarios::DataRoot& data,
                                       const scenarios::Summary& summary);

NumbersByScenario numbers_of_motions(std::span<const scenarios::DrawValues> draws, const scenarios::Summary& summary);

}  // namespace tumble::tools
