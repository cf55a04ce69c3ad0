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

/// Keeps recordings and estimates of a sweep's draws next to its database (README.md, "What is kept").
namespace tumble::scenarios {

/// Rule for which draws are kept. It depends on the results only, not on processes, interruptions or shards.
struct Keep {
  enum class Which { none, failed, worst, all };
  Which which = Which::none;
  std::size_t count = 0;  ///< for `worst`: draws per scenario and method
  bool operator==(const Keep&) const = default;
};

/// Key of the note with the rule, written by `to_string`.
inline constexpr const char* kKeepNote = "keep";

/// Parses "none", "failed", "all", or "worst:N" with N from 1 to 1000. Throws BadInput.
Keep parse_keep(const std::string& text);
std::string to_string(const Keep& keep);

/// A draw of the plain scenario, without settings of curves.
struct DrawName {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const DrawName&) const = default;
};

/// Returns the draws to keep. `all`: every draw with a row. `failed`: draws with a run that is not ok. `worst`: for
/// each scenario and each method without truth, the worst draws by the first headline metric of its kind. Runs that are
/// not ok rank worst; ties prefer lower seeds. Rejected draws have no recording and are never kept.
std::set<DrawName> draws_to_keep(const Results& results, const Keep& keep);

/// The folder of kept draws next to a database, FILE.db.files/kept: SCENARIO/SEED/ with recording.h5,
/// estimates/KIND-METHOD/ and `command`. All functions throw BadInput with path and reason on file system errors.
class KeptDraws {
 public:
  explicit KeptDraws(const std::filesystem::path& database);

  std::filesystem::path folder_of(const DrawName& draw) const;
  /// Returns true if the draw is stored completely, with the estimates of all these rows.
  bool holds(const DrawName& draw, std::span<const Outcome> estimated) const;
  std::vector<DrawName> found() const;
  void remove(const DrawName& draw) const;
  /// Removes incomplete files of a killed process. Requires that no other process writes there.
  void discard_unfinished() const;
  /// Copies the draw, or its missing estimates, from another such folder, by hard links where possible. Returns false
  /// if the other folder does not have the draw.
  bool take(const DrawName& draw, const KeptDraws& from) const;

 private:
  std::filesystem::path folder_;
};

/// Returns the folder of a method's estimate in a draw's folder.
std::filesystem::path estimate_folder(const std::filesystem::path& draw, Kind kind, const std::string& method);

/// Joins the kept draws of a merge, after its rows (merge.hpp). If all inputs and `out` keep by one rule, the result is
/// that of a single sweep. Returns how many draws `out` has afterwards. If the rules differ or nothing is kept, `out`
/// is unchanged.
std::size_t merge_kept(const DatabaseOwner& out, std::span<const std::filesystem::path> in);

}  // namespace tumble::scenarios
