// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>

#include "scenarios/sweep/sweep.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// Sweeps a suite into a database with the progress shown, unless the session is quiet. `stop` ends it early; rows of
/// the statuses `again` are run once more.
scenarios::SweepProgress sweep_with_progress(const Session& session, const scenarios::DataRoot& data,
                                             const scenarios::Suite& suite, const scenarios::DatabaseOwner& database,
                                             int jobs, const std::atomic<bool>& stop,
                                             const std::vector<scenarios::OutcomeStatus>& again = {});

/// "stopped: 3 of 40 draws stored, run again to go on", to standard error; returns the exit status of a stopped sweep.
int say_stopped(const scenarios::SweepProgress& progress);

}  // namespace tumble::tools
