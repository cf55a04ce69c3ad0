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

/// Draws of one sort ("mild"), each with its scenario and its seed.
struct DrawClass {
  std::string name;
  std::vector<std::pair<std::string, std::uint64_t>> draws;
};

/// A suite file, scenarios/suites/NAME.yaml: scenarios x seeds x methods, and once more for each point of each curve;
/// or recordings x methods, each recording standing for one draw (recorded_draw.hpp).
struct Suite {
  std::string name;
  std::string doc;
  std::vector<std::string> scenarios;
  std::uint64_t first_seed = 1, last_seed = 1;
  std::vector<std::string> methods;         ///< names for find_methods
  double timeout_s = 300;                   ///< for one method on one draw
  std::vector<std::string> recordings;      ///< patterns of files, instead of scenarios and seeds
  std::filesystem::path recordings_folder;  ///< that they are relative to: the suite file's, unless told
  std::vector<DrawClass> classes;           ///< key `draws`: of scenarios x seeds these alone; empty: all of them
  std::vector<std::string> shown_metrics;   ///< key `metrics`: what `bench` shows; empty: the headline ones
  std::vector<Variation> curves;            ///< key `vary`: {KEY: [values]}, keys that move together joined by "+"

  bool has_draw(const std::string& scenario, std::uint64_t seed) const;
  /// Of scenarios and seeds, those from `first_seed` to `last_seed`, which may be a shard's; curves not counted.
  std::uint64_t draw_count() const;
};

/// Throws BadInput: the last seed is below the first, or there are more of them than one sweep takes.
void require_seeds(const Suite& suite);

std::vector<std::string> suite_names(const DataRoot& data);
/// A suite by name, a suite file, or a scenario's name (a suite of that one with all methods; of a named case its own
/// seed). Throws BadInput.
Suite load_suite(const DataRoot& data, const std::string& name);

struct SweepProgress {
  std::uint64_t draws_done = 0, draws_total = 0;
  std::uint64_t outcomes = 0, rejected = 0;
  std::map<OutcomeStatus, std::uint64_t> failures;  ///< of the outcomes: how many of each status but ok
  std::uint64_t kept = 0, to_keep = 0;              ///< draws whose files stand, and that are to; at the end
  std::string not_kept;                             ///< why the last one that could not be kept was not
  double elapsed_s = 0, left_s = 0;
  double peak_mib = 0;  ///< largest resident size of any one process that has ended
  std::uint64_t not_ok() const;
};

/// Unless told, what a worker may hold: as much as a command of somebody else's (processes/command.hpp).
inline constexpr double kWorkerMemoryMib = 8192.0;
/// Throws BadInput: no worker can hold so little, or so much.
void require_worker_memory(double mib);

struct SweepOptions {
  int jobs = 1;                             ///< workers
  double memory_mib = kWorkerMemoryMib;     ///< of data (RLIMIT_DATA), of a worker and of each of its methods
  const std::atomic<bool>* stop = nullptr;  ///< set it to end after storing what has finished
  std::function<void(const SweepProgress&)> on_progress;
  std::vector<OutcomeStatus> again;  ///< statuses whose rows are run once more: crashed, timeout, killed
  Keep keep;               ///< draws whose recording and estimates are left beside the database; none: as it is
  RecordingInfo versions;  ///< of program and engine, for recordings that are kept
  /// Where nobody asks for the digest of a recording, which tells whether it holds lidars: draws whose methods of this
  /// build read none are simulated without them, estimates and scores the same. Not together with `keep`.
  bool recordings_unseen = false;
};

/// What a sweep refuses before anything runs: jobs, seeds, statuses to run again, what to keep, memory. Throws
/// BadInput.
void require_sound(const Suite& suite, const SweepOptions& options);

/// Makes the database, or opens it, as one of this suite, build, models and scenarios. Throws BadInput when it is of
/// others.
Results open_results(const DataRoot& data, const Suite& suite, const std::filesystem::path& database);

/// Runs what the database does not hold yet. Workers, processes that serve one draw after the other (draw_worker.hpp),
/// run each method in a process of its own: a crash, a time-out or a memory failure is an outcome (crashed, timeout,
/// killed), never the end of the sweep. Finished outcomes are stored as they come. Draws are looked up and planned one
/// at a time: memory does not grow with their number. At the end what is to be kept stands beside the database, and
/// what was kept and is no longer to be is gone. A recording whose rows were made of other data (another digest) is
/// refused. Returns the final progress; draws_done < draws_total when stopped. Throws BadInput when none of the methods
/// applies to any of the scenarios.
SweepProgress sweep(const DataRoot& data, const Suite& suite, const DatabaseOwner& database,
                    const SweepOptions& options);
/// The same, and owns the database while it runs: throws BadInput when another does.
SweepProgress sweep(const DataRoot& data, const Suite& suite, const std::filesystem::path& database,
                    const SweepOptions& options);

}  // namespace tumble::scenarios
