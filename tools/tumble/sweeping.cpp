// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/sweeping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/certified_results.hpp"
#include "scenarios/sweep/results.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/progress.hpp"

namespace tumble::tools {

namespace {

scenarios::SweepProgress sum(const scenarios::SweepProgress& before, const scenarios::SweepProgress& since,
                             std::uint64_t draws) {
  scenarios::SweepProgress all = since;
  all.draws_done += before.draws_done;
  all.draws_total = draws;
  all.outcomes += before.outcomes;
  all.rejected += before.rejected;
  for (const auto& [status, count] : before.failures) all.failures[status] += count;
  all.elapsed_s += before.elapsed_s;
  all.peak_mib = std::max(all.peak_mib, before.peak_mib);
  if (all.not_kept.empty()) all.not_kept = before.not_kept;
  if (all.draws_done > 0)
    all.left_s = all.elapsed_s / static_cast<double>(all.draws_done) * static_cast<double>(draws - all.draws_done);
  return all;
}

/// Number of further seeds after `done` seeds. The steps grow, so that many processes have enough work.
std::uint64_t step_of(std::uint64_t done) {
  constexpr std::uint64_t kFirstStep = 10;
  return std::max(kFirstStep, done / 4) - 1;
}

}  // namespace

void take_scenarios(const std::vector<std::string>& named, scenarios::Suite& suite) {
  if (named.empty()) return;
  if (!suite.recordings.empty() || !suite.classes.empty())
    throw scenarios::BadInput(
        fmt::format("--scenario does not apply to suite '{}', because the suite file lists the {}", suite.name,
                    suite.recordings.empty() ? "simulated runs" : "recordings"));
  for (const std::string& name : named) require_known("scenario of suite '" + suite.name + "'", name, suite.scenarios);
  std::erase_if(suite.scenarios, [&](const std::string& name) { return std::ranges::count(named, name) == 0; });
}

void certify_results_file(const Session& session, const scenarios::DataRoot& data,
                          const std::filesystem::path& database, const std::atomic<bool>& stop) {
  scenarios::Results results(database, scenarios::Results::Mode::create_or_append);
  bool announced = false;
  scenarios::CertifyOptions options;
  options.stop = &stop;
  options.on_row = [&](const scenarios::CertificateRow&, double) {
    if (!announced)
      session.note(
          "the program measures the agreement of this build's simulation with physics; this happens once per build and "
          "takes about half a minute");
    announced = true;
  };
  const scenarios::Certificate certificate = scenarios::certify_results(
      results, scenarios::CertificateStore(session.cache(), data), {data, session.program()}, options);
  if (!stop.load() && !certificate.passes()) {
    session.note("some measurements of this build's simulation fail; 'tumble certify' shows these measurements");
  }
}

scenarios::SweepProgress sweep_with_progress(const Session& session, const scenarios::DataRoot& data,
                                             const scenarios::Suite& suite, const scenarios::DatabaseOwner& database,
                                             scenarios::SweepOptions options) {
  ProgressDisplay shown = ProgressDisplay::on_standard_error();
  if (!session.quiet) options.on_progress = [&](const scenarios::SweepProgress& p) { shown.show(p); };
  const scenarios::SweepProgress final = scenarios::sweep(data, suite, database, options);
  if (!session.quiet) shown.finish(final);
  return final;
}

AskedSweep sweep_until(const Session& session, const scenarios::DataRoot& data, const scenarios::Suite& suite,
                       const scenarios::DatabaseOwner& database, const scenarios::SweepOptions& options,
                       const scenarios::Question& question) {
  ProgressDisplay shown = ProgressDisplay::on_standard_error();
  AskedSweep out;
  scenarios::Suite part = suite;
  scenarios::SweepOptions own = options;
  if (options.keep.which == scenarios::Keep::Which::worst) own.keep = {};
  const auto draws_of = [&](std::uint64_t seeds) { return seeds * suite.scenarios.size(); };
  const std::uint64_t all = draws_of(suite.last_seed - suite.first_seed + 1);
  while (part.first_seed <= suite.last_seed) {
    const std::uint64_t seed = std::min(suite.last_seed, part.first_seed + step_of(part.first_seed - suite.first_seed));
    part.last_seed = seed;
    const scenarios::SweepProgress before = out.progress;
    if (!session.quiet) own.on_progress = [&](const scenarios::SweepProgress& p) { shown.show(sum(before, p, all)); };
    const std::uint64_t seen = draws_of(seed - suite.first_seed + 1);
    out.progress = sum(before, scenarios::sweep(data, part, database, own), seen);
    if (out.progress.draws_done < seen) break;  // the user stopped the sweep
    out.answers = scenarios::answers({database.database(), scenarios::Results::Mode::read_only}, question, seed);
    if (scenarios::all_answered(out.answers)) break;
    part.first_seed = seed + 1;
  }
  if (own.keep != options.keep && out.progress.draws_done == out.progress.draws_total) {
    own.keep = options.keep;
    own.on_progress = {};
    part.first_seed = suite.first_seed;
    const scenarios::SweepProgress kept = scenarios::sweep(data, part, database, own);
    out.progress.kept = kept.kept;
    out.progress.to_keep = kept.to_keep;
    out.progress.not_kept = kept.not_kept;
  }
  if (!session.quiet) shown.finish(out.progress);
  return out;
}

int say_stopped(const scenarios::SweepProgress& progress) {
  std::fprintf(stderr, "tumble: stopped: %llu of %llu simulated runs are stored; run again to continue\n",
               static_cast<unsigned long long>(progress.draws_done),
               static_cast<unsigned long long>(progress.draws_total));
  return kCheckFailed;
}

}  // namespace tumble::tools
