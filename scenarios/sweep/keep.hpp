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

#include "scenarios/estimates/method.hpp"
#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Keep selects the simulated runs whose files are kept. The selection depends only on the results, and not on
/// interruptions or parallel parts of the sweep.
struct Keep {
  enum class Which { none, failed, worst, all };
  Which which = Which::none;
  std::size_t count = 0;  ///< for `worst`: per scenario and method
  bool operator==(const Keep&) const = default;
};

inline constexpr const char* kKeepNote = "keep";

Keep parse_keep(const std::string& text);
std::string to_string(const Keep& keep);

struct DrawName {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): false positive of clang-tidy 14 for a defaulted operator<=>
  auto operator<=>(const DrawName&) const = default;
};

/// Selects the runs whose files are kept. The setting `worst` selects the worst runs of each scenario and method,
/// ranked by the first headline metric of the method's kind. Methods that use the truth are ignored.
std::set<DrawName> draws_to_keep(const Results& results, const Keep& keep);

/// KeptDraws is the folder of kept runs next to a results database, FILE.db.files/kept. Each kept run has a folder
/// SCENARIO/SEED/.
class KeptDraws {
 public:
  explicit KeptDraws(const std::filesystem::path& database);

  std::filesystem::path folder_of(const DrawName& draw) const;
  bool holds(const DrawName& draw, std::span<const Outcome> estimated) const;
  std::vector<DrawName> found() const;
  void remove(const DrawName& draw) const;
  void discard_unfinished() const;
  /// Copies a kept run from the folder `from`. If the run exists in the destination, only the missing estimates are
  /// copied. Returns false if `from` does not contain the run.
  bool take(const DrawName& draw, const KeptDraws& from) const;

 private:
  std::filesystem::path folder_;
};

std::filesystem::path estimate_folder(const std::filesystem::path& draw, Kind kind, const std::string& method);

std::size_t merge_kept(const DatabaseOwner& out, std::span<const std::filesystem::path> in);

}  // namespace tumble::scenarios
