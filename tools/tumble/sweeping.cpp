// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/sweeping.hpp"

#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "tools/tumble/progress.hpp"

namespace tumble::tools {

scenarios::SweepProgress sweep_with_progress(const Session& session, const scenarios::DataRoot& data,
                                             const scenarios::Suite& suite, const scenarios::DatabaseOwner& database,
                                             int jobs, const std::atomic<bool>& stop,
                                             const std::vector<scenarios::OutcomeStatus>& again) {
  const auto to_standard_error = [](std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  };
  ProgressDisplay display(to_standard_error, isatty(STDERR_FILENO) == 1);
  scenarios::SweepOptions options;
  options.jobs = jobs;
  options.stop = &stop;
  options.again = again;
  if (!session.quiet) options.on_progress = [&](const scenarios::SweepProgress& p) { display.show(p); };
  const scenarios::SweepProgress final = scenarios::sweep(data, suite, database, options);
  if (!session.quiet) display.finish(final);
  return final;
}

int say_stopped(const scenarios::SweepProgress& progress) {
  std::fprintf(stderr, "tumble: stopped: %llu of %llu draws stored, run again to go on\n",
               static_cast<unsigned long long>(progress.draws_done),
               static_cast<unsigned long long>(progress.draws_total));
  return kCheckFailed;
}

}  // namespace tumble::tools
