// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"
#include "tools/tumble/session.hpp"
#include "tumble/common/status.hpp"

namespace tumble::tools {

scenarios::MethodPointer chosen_method(const std::string& name, const scenarios::Subject& subject);

/// Shows the progress on a terminal.
scenarios::Estimate run_method(const Session& session, const scenarios::Method& method, const sim::Sensors& sensors);

std::string failure_reason(const Status& status, const sim::Sensors& sensors);

std::string trouble_place(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
