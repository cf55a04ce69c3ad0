// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// One row of the view scores(scenario, seed, kind, method, status, metric, value). An outcome without any score has
/// one row with an empty metric and NaN; a rejected draw one with kind and method empty too, status `rejected`.
struct ScoreRow {
  std::string scenario;
  std::uint64_t seed;
  std::string kind, method;
  OutcomeStatus status;
  std::string metric;
  double value;
  Setting setting = {};
};

/// Which rows are asked for: those of the scenarios and methods as they are, those that belong to a curve, or both.
enum class Rows { plain, curves, all };

/// What a merge wrote: rows that were not there, rows that took the place of a worse one, and what the inputs held
/// besides, which stood already.
struct MergeCounts {
  std::size_t added = 0, replaced = 0, held = 0;
  std::size_t rejected = 0;  ///< draws, of those added
};

/// Names that rows share, kept once by who reads them.
using Names = std::set<std::string, std::less<>>;

/// An outcome as it is read, for results of any size: what it points to goes with the next one, but the names.
struct OutcomeView {
  struct Value {
    const std::string* metric;  ///< in the `Names` of the reader
    double value;
  };
  std::string_view scenario;
  std::uint64_t seed;
  Kind kind;
  std::string_view method;
  OutcomeStatus status;
  std::string_view varied;
  double setting;
  std::span<const Value> scores;  ///< by name
};

/// Key of the note that tells the version of a method that is not of the build: "method slam/theirs".
std::string method_note(Kind kind, const std::string& name);
bool is_method_note(const std::string& key);

/// The results database (SQLite). Rows are unique by (scenario, seed, kind, method, setting); storing again replaces.
/// Each store is one transaction, so that whatever has finished survives a kill.
class Results {
 public:
  /// `join` is `create_or_append` for who calls `absorb` and stores no outcome besides: that each score has its outcome
  /// is seen to there, and the engine does not look it up for each.
  enum class Mode { create_or_append, join, read_only };
  /// Throws BadInput: absent (read_only), not a results database, without a table, column or view of the schema,
  /// written by another build (but read_only; note "build"), no room. So do all members, with the path in the
  /// message, also where a value that they read is no number (text, a blob).
  Results(const std::filesystem::path& path, Mode mode);
  ~Results();
  Results(Results&&) noexcept;

  /// A score without a name, as `scores()` has it for an outcome that has none, is left out. A rejection of the same
  /// draw goes: what has run could be drawn.
  void store(const Outcome& outcome);
  /// Not where an outcome of the draw stands; false then.
  bool store(const RejectedDraw& rejected);
  void store(const DrawValues& draw);
  /// Replaces what was known of its build.
  void store(const Certificate& certificate);
  /// A free text kept with the results: "suite", "build", "data".
  void set_note(const std::string& key, const std::string& text);
  std::string note(const std::string& key) const;
  std::map<std::string, std::string> notes() const;
  /// All rows of another database but its notes, by the rule of merge.hpp, row by row: memory does not grow with their
  /// number. Throws BadInput when two rows that were scored differ in status, digest or a score that is no cost, unless
  /// `mixed`.
  void absorb(const Results& shard, bool mixed, MergeCounts& counts);
  /// All that `work` stores, or, when it throws, nothing of it. Throws what it throws.
  void in_one_transaction(const std::function<void()>& work);

  /// Whether any draw has an outcome or a rejection.
  bool has_rows() const;
  /// The row with the scenario, seed, kind, method and setting of `key`, without its scores.
  std::optional<Outcome> find(const Outcome& key) const;
  /// What is held of one draw, curves included, without scores.
  std::vector<Outcome> outcomes_of(const std::string& scenario, std::uint64_t seed) const;
  std::vector<RejectedDraw> rejected_of(const std::string& scenario, std::uint64_t seed) const;
  /// Every outcome with its scores, in the order of storing; nothing is kept but the metrics' names.
  void each(Rows rows, Names& names, const std::function<void(const OutcomeView&)>& visit) const;
  std::vector<ScoreRow> scores(Rows rows = Rows::plain) const;
  /// Every outcome without its scores.
  std::vector<Outcome> outcomes(Rows rows = Rows::plain) const;
  std::vector<RejectedDraw> rejected(Rows rows = Rows::plain) const;
  std::vector<DrawValues> draws(Rows rows = Rows::plain) const;
  /// One per build, its entries in their order; a database that was merged may hold several.
  std::vector<Certificate> certificates() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::scenarios
