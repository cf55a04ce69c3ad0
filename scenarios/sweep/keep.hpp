// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"

/// The functions in keep.hpp keep recordings and estimates of a sweep's simulated runs next to its database (README.md,
/// "What is kept").
namespace tumble::scenarios {

/// Keep is the rule that selects which simulated runs of a sweep are kept on disk. The selection depends only on the
/// results, regardless of processes, interruptions or parallel parts of the sweep.
struct Keep {
  enum class Which { none, failed, worst, all };
  Which which = Which::none;
  std::size_t count = 0;  ///< for `worst`: runs per scenario and method
  bool operator==(const Keep&) const = default;
};

/// kKeepNote is the key under which the results database stores the keep rule, as text from `to_string`.
inline constexpr const char* kKeepNote = "keep";

/// Parses a keep rule: "none", "failed", "all", or "worst:N" with N from 1 to 1000. Throws BadInput for any other text.
Keep parse_keep(const std::string& text);
std::string to_string(const Keep& keep);

/// DrawName identifies a simulated run by its scenario and seed, without the setting of a curve.
struct DrawName {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const DrawName&) const = default;
};

/// Returns the simulated runs that the keep rule selects. The rule `all` keeps every run in the results. The rule
/// `failed` keeps runs whose status is not ok. The rule `worst` keeps the worst runs of each scenario and each method
/// that does not use the truth. The first headline metric of the method's kind ranks the runs. Runs that are not ok
/// rank worst. Among equally bad runs, lower seeds are kept first. A run that could not be simulated has no recording
/// and is never kept.
std::set<DrawName> draws_to_keep(const Results& results, const Keep& keep);

/// KeptDraws is the folder of kept runs next to a database, FILE.db.files/kept. Each run has a folder SCENARIO/SEED/
/// with recording.h5, estimates/KIND-METHOD/ and `command`. All functions throw BadInput with path and reason on file
/// system errors.
class KeptDraws {
 public:
  explicit KeptDraws(const std::filesystem::path& database);

  std::filesystem::path folder_of(const DrawName& draw) const;
  /// Returns whether the run is stored completely, with the estimates of all outcomes in `estimated`.
  bool holds(const DrawName& draw, std::span<const Outcome> estimated) const;
  std::vector<DrawName> found() const;
  void remove(const DrawName& draw) const;
  /// Removes incomplete files that a killed process has left. During the call, no other process may write to the
  /// folder.
  void discard_unfinished() const;
  /// Copies a kept run, or only its missing estimates, from another folder of kept runs. The copy uses hard links where
  /// possible. Returns false if the folder `from` does not contain the run.
  bool take(const DrawName& draw, const KeptDraws& from) const;

 private:
  std::filesystem::path folder_;
};

/// Returns the folder of a method's estimate in the folder of a run.
std::filesystem::path estimate_folder(const std::filesystem::path& draw, Kind kind, const std::string& method);

/// Joins the kept runs of several databases, after their rows were joined (merge.hpp). If all databases have the same
/// keep rule, the result equals the kept runs of a single sweep. Returns the number of kept runs in `out` after the
/// merge. If the rules differ or nothing is kept, the folder of `out` is unchanged.
std::size_t merge_kept(const DatabaseOwner& out, std::span<const std::filesystem::path> in);

}  // namespace tumble::scenarios
