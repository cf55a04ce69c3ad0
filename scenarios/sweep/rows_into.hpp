// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

class Kept {
 public:
  const std::string& operator()(std::string_view text) {
    auto& last = last_[text.size() % last_.size()];
    if (last != nullptr && *last == text) return *last;
    auto found = texts_.find(text);
    if (found == texts_.end()) found = texts_.emplace(text).first;
    return *(last = &*found);
  }

 private:
  std::set<std::string, std::less<>> texts_;
  std::array<const std::string*, 64> last_{};
};

struct ScoreValue {
  std::int64_t outcome;
  const std::string* metric;
  double value;

  static constexpr const char *kTable = "score_values", *kPlaces = "(?, ?, ?)";
  static constexpr int kColumns = 3;
  void bind(SQLite::Statement& to, int before) const {
    to.bind(before + 1, outcome);
    to.bindNoCopy(before + 2, *metric);
    to.bind(before + 3, value);
  }
};

struct DrawValue {
  const std::string* scenario;
  std::int64_t seed;
  const std::string* metric;
  double value;
  const std::string* varied;
  double setting;

  static constexpr const char *kTable = "draw_values", *kPlaces = "(?, ?, ?, ?, ?, ?)";
  static constexpr int kColumns = 6;
  void bind(SQLite::Statement& to, int before) const {
    to.bindNoCopy(before + 1, *scenario);
    to.bind(before + 2, seed);
    to.bindNoCopy(before + 3, *metric);
    to.bind(before + 4, value);
    to.bindNoCopy(before + 5, *varied);
    to.bind(before + 6, setting);
  }
};

template <typename Row>
class RowsInto {
 public:
  explicit RowsInto(SQLite::Database& into) : one_(into, text(1)), many_(into, text(kMany)) {}

  void add(const Row& row) {
    rows_.push_back(row);
    if (rows_.size() == kMany) flush();
  }
  void flush() {
    if (rows_.size() == kMany) {
      for (std::size_t i = 0; i < kMany; ++i) rows_[i].bind(many_, static_cast<int>(i) * Row::kColumns);
      run(many_);
    } else {
      for (const Row& row : rows_) {
        row.bind(one_, 0);
        run(one_);
      }
    }
    rows_.clear();
  }

 private:
  static constexpr std::size_t kMany = 64;

  static std::string text(std::size_t rows) {
    std::string text = std::string("INSERT OR REPLACE INTO ") + Row::kTable + " VALUES " + Row::kPlaces;
    for (std::size_t i = 1; i < rows; ++i) text.append(", ").append(Row::kPlaces);
    return text;
  }
  static void run(SQLite::Statement& statement) {
    statement.exec();
    statement.reset();
  }

  std::vector<Row> rows_;
  SQLite::Statement one_, many_;
};

}  // namespace tumble::scenarios
