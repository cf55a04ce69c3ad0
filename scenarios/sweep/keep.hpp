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

/// keep.hpp keeps recordings and estimates of a sweep's simulated runs next to its database (README.md, "What is
/// kept").
namespace tumble::scenarios {

/// Keep is the rule that selects which simulated runs of a sweep are kept on disk. The selection depends only on the
/// results, and not on processes, interruptions or parallel parts of the sweep.
struct Keep {
  enum class Which { none, failed, worst, all };
  Which which = Which::none;
  std::size_t count = 0;  ///< for `worst`: number of runs per scenario and method
  bool operator==(const Keep&) const = default;
};

/// Key under which the results database stores the rule, as text from `to_string`.
inline constexpr const char* kKeepNote = "keep";

/// Parses a rule: "none", "failed", "all", or "worst:N" with N from 1 to 1000. Throws BadInput for another text.
Keep parse_keep(const std::string& text);
std::string to_string(const Keep& keep);

/// DrawName identifies a simulated run by scenario and seed.
struct DrawName {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const DrawName&) const = default;
};

/// Returns the simulated runs that the rule selects. `all` keeps every run in the results. `failed` keeps runs whose
/// status is not ok. `worst` keeps the worst runs per scenario and method (without methods that use the truth), ranked
/// by the first headline metric of the method's kind. Runs that are not ok rank worst; of equally bad runs, the lower
/// seeds come first. A run that could not be simulated has no recording and is never kept.
std::set<DrawName> draws_to_keep(const Results& results, const Keep& keep);

/// KeptDraws is the folder of kept runs next to a database, FILE.db.files/kept. Each run has a folder SCENARIO/SEED/
/// with recording.h5, estimates/KIND-METHOD/ and `command`. All functions throw BadInput with path and reason on file
/// system errors.
class KeptDraws {
 public:
  explicit KeptDraws(const std::filesystem::path& database);

  std::filesystem::path folder_of(const DrawName& draw) const;
  /// Returns true if the run is stored completely, with the estimates of all outcomes in `estimated`.
  bool holds(const DrawName& draw, std::span<const Outcome> estimated) const;
  std::vector<DrawName> found() const;
  void remove(const DrawName& draw) const;
  /// Removes incomplete files that a killed process has left. No other process may write to the folder during the call.
  void discard_unfinished() const;
  /// Copies a kept run, or only its missing estimates, from another folder of kept runs, with hard links where
  /// possible. Returns false if `from` does not contain the run.
  bool take(const DrawName& draw, const KeptDraws& from) const;

 private:
  std::filesystem::path folder_;
};

/// Returns the folder of a method's estimate in the folder of a run.
std::filesystem::path estimate_folder(const std::filesystem::path& draw, Kind kind, const std::string& method);

/// Joins the kept runs of several databases, after their rows were joined (merge.hpp). If all databases have the same
/// rule, the result equals the kept runs of a single sweep. If the rules differ or nothing is kept, the folder of `out`
/// is unchanged. Returns the number of kept runs in `out`.
std::size_t merge_kept(const DatabaseOwner& out, std::span<const std::filesystem::path> in);

}  // namespace tumble::scenarios
