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
#include "scenarios/estimates/method.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/keep.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "scenarios/sweep/variation.hpp"

namespace tumble::scenarios {

struct DrawClass {
  std::string name;
  std::vector<std::pair<std::string, std::uint64_t>> draws;
};

/// Suite is the content of a suite file, scenarios/suites/NAME.yaml. A suite selects methods, and either recordings or
/// scenarios with several seeds.
struct Suite {
  std::string name;
  std::string doc;
  std::vector<std::string> scenarios;
  std::uint64_t first_seed = 1, last_seed = 1;
  std::vector<std::string> methods;         ///< names for find_methods
  double timeout_s = 300;                   ///< of one method on one run
  std::vector<std::string> recordings;      ///< instead of scenarios and seeds
  std::filesystem::path recordings_folder;  ///< default: folder of the suite
  std::vector<DrawClass> classes;           ///< key `draws`; empty: all
  std::vector<std::string> shown_metrics;   ///< key `metrics`; empty: headline metrics
  std::vector<Variation> curves;            ///< key `vary`: {KEY: [values]}

  bool has_draw(const std::string& scenario, std::uint64_t seed) const;
  std::uint64_t draw_count() const;
};

void require_seeds(const Suite& suite);

std::vector<std::string> suite_names(const DataRoot& data);
/// Loads a suite by its name or from a suite file. If the name is the name of a scenario, the suite runs all methods on
/// this scenario.
Suite load_suite(const DataRoot& data, const std::string& name);

struct SweepProgress {
  std::uint64_t draws_done = 0, draws_total = 0;
  std::uint64_t outcomes = 0, rejected = 0;
  std::map<OutcomeStatus, std::uint64_t> failures;  ///< not ok, by status
  std::uint64_t kept = 0, to_keep = 0;              ///< set at the end
  std::string not_kept;                             ///< latest error
  double elapsed_s = 0, left_s = 0;
  double peak_mib = 0;  ///< of any finished process
  std::uint64_t not_ok() const;
};

inline constexpr double kWorkerMemoryMib = 8192.0;
void require_worker_memory(double mib);

struct SweepOptions {
  int jobs = 1;                             ///< number of workers
  double memory_mib = kWorkerMemoryMib;     ///< of a worker and its children
  const std::atomic<bool>* stop = nullptr;  ///< stops after storing completed results
  std::function<void(const SweepProgress&)> on_progress;
  std::vector<OutcomeStatus> again;  ///< to repeat: crashed, timeout, killed
  Keep keep;                         ///< `none` keeps existing files
  RecordingInfo versions;            ///< for kept recordings
  /// If true, lidars that no method of a task reads are not simulated. Estimates and scores are unchanged, but the
  /// digest (hash) of the recording differs.
  bool recordings_unseen = false;
  /// Selects the methods that run on each scenario; if empty, all methods of the suite that apply to the scenario.
  std::function<bool(const std::string& scenario, const MethodInfo& method)> selects;
};

void require_sound(const Suite& suite, const SweepOptions& options);

/// Opens a results database. Throws BadInput if the results come from another suite, another build, or other models or
/// scenarios.
Results open_results(const DataRoot& data, const Suite& suite, const std::filesystem::path& database);

/// Executes the runs of the suite that are missing in the database. Worker processes run each method in a separate
/// process. If a method crashes, times out or exceeds its memory limit, the outcome is crashed, timeout or killed, and
/// the sweep continues. Memory use does not depend on the number of simulated runs.
SweepProgress sweep(const DataRoot& data, const Suite& suite, const DatabaseOwner& database,
                    const SweepOptions& options);

}  // namespace tumble::scenarios
