// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/summary/question.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// Sweeps a suite into a database with the progress shown, unless the session is quiet.
scenarios::SweepProgress sweep_with_progress(const Session& session, const scenarios::DataRoot& data,
                                             const scenarios::Suite& suite, const scenarios::DatabaseOwner& database,
                                             scenarios::SweepOptions options);

/// The same until the question is answered of all its scenarios, or the seeds are at their end. It is looked at after
/// fixed numbers of seeds, with all of their draws done and none of the later ones begun, so that what the database
/// comes to hold depends neither on the number of jobs nor on interruptions.
struct AskedSweep {
  scenarios::SweepProgress progress;  ///< of all looks; `draws_total` are the draws up to the last look
  std::vector<scenarios::Answer> answers;
};
AskedSweep sweep_until(const Session& session, const scenarios::DataRoot& data, const scenarios::Suite& suite,
                       const scenarios::DatabaseOwner& database, const scenarios::SweepOptions& options,
                       const scenarios::Question& question);

/// "stopped: 3 of 40 draws stored, run again to go on", to standard error; returns the exit status of a stopped sweep.
int say_stopped(const scenarios::SweepProgress& progress);

}  // namespace tumble::tools
