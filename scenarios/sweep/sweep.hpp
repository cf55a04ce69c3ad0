// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/keep.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep_notes.hpp"
#include "scenarios/sweep/variation.hpp"

namespace tumble::scenarios {

struct DrawClass {
  std::string name;
  std::vector<std::pair<std::string, std::uint64_t>> draws;
};

/// A suite file, scenarios/suites/NAME.yaml, selects methods and either scenarios with several seeds or recordings.
struct Suite {
  std::string name;
  std::string doc;
  std::vector<std::string> scenarios;
  std::uint64_t first_seed = 1, last_seed = 1;
  std::vector<std::string> methods;         ///< names for find_methods
  double timeout_s = 300;                   ///< time limit of one method on one run
  std::vector<std::string> recordings;      ///< file patterns, instead of scenarios and seeds
  std::filesystem::path recordings_folder;  ///< base folder of the patterns; default: folder of the suite file
  std::vector<DrawClass> classes;           ///< key `draws`: only these runs of scenarios x seeds; empty: all
  std::vector<std::string> shown_metrics;   ///< key `metrics`: shown by `bench`; empty: the headline metrics
  std::vector<Variation> curves;            ///< key `vary`: {KEY: [values]}; "+" joins keys that change together

  bool has_draw(const std::string& scenario, std::uint64_t seed) const;
  std::uint64_t draw_count() const;
};

void require_seeds(const Suite& suite);

std::vector<std::string> suite_names(const DataRoot& data);
/// Loads a suite by its name, from a suite file, or from the name of a scenario, which gives a suite of all methods on
/// this scenario. Throws BadInput if the name is unknown or the file is invalid.
Suite load_suite(const DataRoot& data, const std::string& name);

struct SweepProgress {
  std::uint64_t draws_done = 0, draws_total = 0;
  std::uint64_t outcomes = 0, rejected = 0;
  std::map<OutcomeStatus, std::uint64_t> failures;  ///< outcomes that are not ok, by status
  std::uint64_t kept = 0, to_keep = 0;              ///< kept runs, and runs that should be kept; set at the end
  std::string not_kept;                             ///< latest error when keeping a run
  double elapsed_s = 0, left_s = 0;
  double peak_mib = 0;  ///< largest resident memory of any finished process
  std::uint64_t not_ok() const;
};

inline constexpr double kWorkerMemoryMib = 8192.0;
void require_worker_memory(double mib);

struct SweepOptions {
  int jobs = 1;                             ///< number of workers
  double memory_mib = kWorkerMemoryMib;     ///< memory limit (RLIMIT_DATA) of a worker and of its child processes
  const std::atomic<bool>* stop = nullptr;  ///< set to stop after storing completed results
  std::function<void(const SweepProgress&)> on_progress;
  std::vector<OutcomeStatus> again;  ///< statuses of rows to repeat: crashed, timeout, killed
  Keep keep;                         ///< rule for kept runs; `none` leaves kept files unchanged
  RecordingInfo versions;            ///< versions of program and physics engine, for kept recordings
  /// If true, lidars that no method of a task reads are not simulated; estimates and scores are unchanged, but the
  /// digest of the recording differs.
  bool recordings_unseen = false;
};

void require_sound(const Suite& suite, const SweepOptions& options);

/// Throws BadInput if the results database belongs to another suite, build, models or scenarios.
Results open_results(const DataRoot& data, const Suite& suite, const std::filesystem::path& database);

/// Executes the runs of the suite that the database lacks; worker processes run each method in a separate process. If a
/// method crashes, times out or exceeds its memory, its outcome is crashed, timeout or killed, and the sweep continues.
/// Each outcome is stored when it is complete. Simulated runs are planned one at a time, so memory use does not depend
/// on their number. Throws BadInput if the results of a recording come from other data, or if no method can run on any
/// scenario.
SweepProgress sweep(const DataRoot& data, const Suite& suite, const DatabaseOwner& database,
                    const SweepOptions& options);
SweepProgress sweep(const DataRoot& data, const Suite& suite, const std::filesystem::path& database,
                    const SweepOptions& options);

}  // namespace tumble::scenarios
