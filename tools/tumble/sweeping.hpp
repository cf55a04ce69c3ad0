// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/summary/question.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// Keeps only the named scenarios of a suite, in the order of the suite; all if `named` is empty.
void take_scenarios(const std::vector<std::string>& named, scenarios::Suite& suite);

/// Stores the certificate of this build (checks of its simulation) in a results database. The certificate is measured
/// at most once per build and machine.
void certify_results_file(const Session& session, const scenarios::DataRoot& data,
                          const std::filesystem::path& database, const std::atomic<bool>& stop);

scenarios::SweepProgress sweep_with_progress(const Session& session, const scenarios::DataRoot& data,
                                             const scenarios::Suite& suite, const scenarios::DatabaseOwner& database,
                                             scenarios::SweepOptions options);

/// AskedSweep sweeps until the question is answered for all its scenarios, or the seeds are used up. The question is
/// evaluated after numbers of seeds that do not depend on the number of jobs or on interruptions.
struct AskedSweep {
  scenarios::SweepProgress progress;  ///< of all steps
  std::vector<scenarios::Answer> answers;
};
AskedSweep sweep_until(const Session& session, const scenarios::DataRoot& data, const scenarios::Suite& suite,
                       const scenarios::DatabaseOwner& database, const scenarios::SweepOptions& options,
                       const scenarios::Question& question);

int say_stopped(const scenarios::SweepProgress& progress);

}  // namespace tumble::tools
