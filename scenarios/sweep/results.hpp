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

/// ScoreRow is one metric value of one outcome. An outcome without scores has one row with an empty metric and the
/// value NaN. A run that could not be simulated has one row with empty kind and method and the status `rejected`.
struct ScoreRow {
  std::string scenario;
  std::uint64_t seed;
  std::string kind, method;
  OutcomeStatus status;
  std::string metric;
  double value;
  Setting setting = {};
};

enum class Rows { plain, curves, all };

struct MergeCounts {
  std::size_t added = 0, replaced = 0, held = 0;
  std::size_t rejected = 0;  ///< among the added rows
};

using Names = std::set<std::string, std::less<>>;

/// The pointers in an OutcomeView are valid until the reader returns the next outcome. Pointers to names stay valid.
struct OutcomeView {
  struct Value {
    const std::string* metric;  ///< points into the reader's `Names`
    double value;
  };
  std::string_view scenario;
  std::uint64_t seed;
  Kind kind;
  std::string_view method;
  OutcomeStatus status;
  std::string_view varied;
  double setting;
  std::span<const Value> scores;  ///< sorted by name
};

std::string method_note(Kind kind, const std::string& name);
bool is_method_note(const std::string& key);

/// Results is a results database (SQLite) with at most one row per scenario, seed, kind, method and setting. Each call
/// of store() is one transaction, so stored results are not lost if the process is killed.
class Results {
 public:
  enum class Mode { create_or_append, join, read_only };
  /// Throws BadInput if the file is not a results database, has an incomplete schema, or was written by another build.
  /// The mode `read_only` accepts databases of other builds. In the mode `join`, an error during writing can damage the
  /// database.
  Results(const std::filesystem::path& path, Mode mode);
  ~Results();
  Results(Results&&) noexcept;

  void store(const Outcome& outcome);
  bool store(const RejectedDraw& rejected);
  void store(const DrawValues& draw);
  void store(const Certificate& certificate);
  void set_note(const std::string& key, const std::string& text);
  std::string note(const std::string& key) const;
  std::map<std::string, std::string> notes() const;
  /// Copies all rows of another results database `shard`; memory use does not depend on the number of rows. The caller
  /// must not have an open transaction.
  void absorb(const Results& shard, bool mixed, MergeCounts& counts);
  void in_one_transaction(const std::function<void()>& work);

  bool has_rows() const;
  std::optional<Outcome> find(const Outcome& key) const;
  std::vector<Outcome> outcomes_of(const std::string& scenario, std::uint64_t seed) const;
  std::vector<RejectedDraw> rejected_of(const std::string& scenario, std::uint64_t seed) const;
  void each(Rows rows, Names& names, const std::function<void(const OutcomeView&)>& visit) const;
  std::vector<ScoreRow> scores(Rows rows = Rows::plain) const;
  std::vector<Outcome> outcomes(Rows rows = Rows::plain) const;
  std::vector<RejectedDraw> rejected(Rows rows = Rows::plain) const;
  std::vector<DrawValues> draws(Rows rows = Rows::plain) const;
  std::vector<Certificate> certificates() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::scenarios
