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

/// Recordings and estimates of a sweep's draws, kept beside its database (README.md, "What is kept").
namespace tumble::scenarios {

/// Which draws are kept, as a function of the results alone: neither the number of processes nor an interruption, nor
/// in how many shards they came to be, changes it.
struct Keep {
  enum class Which { none, failed, worst, all };
  Which which = Which::none;
  std::size_t count = 0;  ///< of `worst`: draws of each scenario and method
  bool operator==(const Keep&) const = default;
};

/// The note of results whose draws are kept: `to_string` of the Keep.
inline constexpr const char* kKeepNote = "keep";

/// "none", "failed", "all", or "worst:N" with N from 1 to 1000. Throws BadInput.
Keep parse_keep(const std::string& text);
std::string to_string(const Keep& keep);

/// A draw of the plain scenario, without what a curve changes.
struct DrawName {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const DrawName&) const = default;
};

/// `all`: each that has a row. `failed`: on which a run is not ok. `worst`: of each scenario and each method that needs
/// no truth those with the worst values of the first headline metric of its kind, a run that is not ok being the worst
/// of all; of equal ones those with the lower seeds. Draws that were rejected have no recording and are none of them.
std::set<DrawName> draws_to_keep(const Results& results, const Keep& keep);

/// The folder of kept draws beside a database, FILE.db.files/kept: SCENARIO/SEED/ with recording.h5,
/// estimates/KIND-METHOD/ and `command`. All throw BadInput with path and reason where the disk refuses.
class KeptDraws {
 public:
  explicit KeptDraws(const std::filesystem::path& database);

  std::filesystem::path folder_of(const DrawName& draw) const;
  /// Whether the draw stands there whole, with the estimates of all these rows.
  bool holds(const DrawName& draw, std::span<const Outcome> estimated) const;
  std::vector<DrawName> found() const;
  void remove(const DrawName& draw) const;
  /// What a process that was killed has not brought to its end. For when no other writes there.
  void discard_unfinished() const;
  /// The draw out of another such folder, or the estimates of it that are not here; by hard links where the file system
  /// can. False where the other has it not.
  bool take(const DrawName& draw, const KeptDraws& from) const;

 private:
  std::filesystem::path folder_;
};

/// The folder of a method's estimate in a draw's.
std::filesystem::path estimate_folder(const std::filesystem::path& draw, Kind kind, const std::string& method);

/// Joins what is kept beside the databases of a merge, after their rows (merge.hpp): where all of them and `out` keep
/// by one rule, `out` is as if it had been swept at once. Returns how many draws `out` now has. Where rules differ, or
/// none keeps, nothing is done, and what `out` had kept stays.
std::size_t merge_kept(const DatabaseOwner& out, std::span<const std::filesystem::path> in);

}  // namespace tumble::scenarios
