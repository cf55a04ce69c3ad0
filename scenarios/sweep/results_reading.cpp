// SPDX-License-Identifier: BSD-3-Clause
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/results_database.hpp"

namespace tumble::scenarios {

namespace {

std::string draw_text(const std::string& scenario, std::uint64_t seed) {
  return scenario + ", seed " + std::to_string(seed);
}

const char* picked(Rows rows) {
  switch (rows) {
    case Rows::plain:
      return "varied = ''";
    case Rows::curves:
      return "varied <> ''";
    case Rows::all:
      return "1";
  }
  return "0";
}

constexpr const char* kOutcomes =
    "SELECT scenario, seed, kind, method, status, message, recording_digest, estimate_digest, varied, setting "
    "FROM outcomes WHERE kind <> '' AND ";
constexpr const char* kRejections =
    "SELECT scenario, seed, message, varied, setting FROM outcomes WHERE kind = '' AND ";
constexpr const char* kInOrder = " ORDER BY varied, setting, scenario, seed, kind, method";

std::vector<Outcome> read_outcomes(SQLite::Statement& select, const std::filesystem::path& path) {
  std::vector<Outcome> found;
  while (select.executeStep()) {
    Outcome row;
    row.scenario = select.getColumn(0).getString();
    row.seed = read_seed(select.getColumn(1).getInt64());
    row.kind = stored_kind(select.getColumn(2).getString(), path);
    row.method = select.getColumn(3).getString();
    row.status = stored_status(select.getColumn(4).getString(), path);
    row.message = select.getColumn(5).getString();
    row.recording_digest = select.getColumn(6).getString();
    row.estimate_digest = select.getColumn(7).getString();
    row.setting = {select.getColumn(8).getString(), select.getColumn(9).getDouble()};
    found.push_back(std::move(row));
  }
  return found;
}

std::vector<RejectedDraw> read_rejected(SQLite::Statement& select) {
  std::vector<RejectedDraw> found;
  while (select.executeStep()) {
    found.push_back({select.getColumn(0).getString(),
                     read_seed(select.getColumn(1).getInt64()),
                     select.getColumn(2).getString(),
                     {select.getColumn(3).getString(), select.getColumn(4).getDouble()}});
  }
  return found;
}

}  // namespace

bool Results::has_rows() const {
  return impl_->guarded(
      [&] { return impl_->database.execAndGet("SELECT EXISTS (SELECT 1 FROM outcomes)").getInt() != 0; });
}

std::optional<Outcome> Results::find(const Outcome& key) const {
  for (Outcome& held : outcomes_of(key.scenario, key.seed)) {
    if (held.kind == key.kind && held.method == key.method && held.setting == key.setting) return std::move(held);
  }
  return std::nullopt;
}

std::vector<ScoreRow> Results::scores(Rows rows) const {
  return impl_->guarded([&] {
    std::vector<ScoreRow> found;
    SQLite::Statement select(impl_->database,
                             std::string("SELECT o.scenario, o.seed, o.kind, o.method, o.status, s.metric, s.value, "
                                         "o.varied, o.setting FROM outcomes AS o LEFT JOIN score_values AS s "
                                         "ON s.outcome = o.id WHERE ") +
                                 picked(rows) +
                                 " ORDER BY o.varied, o.setting, o.scenario, o.seed, o.kind, o.method, s.metric");
    while (select.executeStep()) {
      ScoreRow row = {select.getColumn(0).getString(),
                      read_seed(select.getColumn(1).getInt64()),
                      select.getColumn(2).getString(),
                      select.getColumn(3).getString(),
                      stored_status(select.getColumn(4).getString(), impl_->path),
                      select.getColumn(5).isNull() ? std::string() : select.getColumn(5).getString(),
                      0.0,
                      {select.getColumn(7).getString(), select.getColumn(8).getDouble()}};
      row.value = stored_value(select.getColumn(6), impl_->path, [&] {
        return draw_text(row.scenario, row.seed) + ", " + row.kind + "/" + row.method + ", " + row.metric;
      });
      found.push_back(std::move(row));
    }
    return found;
  });
}

void Results::each(Rows rows, Names& names, const std::function<void(const OutcomeView&)>& visit) const {
  impl_->guarded([&] {
    SQLite::Statement outcomes(impl_->database,
                               std::string("SELECT id, scenario, seed, kind, method, status, varied, setting "
                                           "FROM outcomes WHERE kind <> '' AND ") +
                                   picked(rows) + " ORDER BY id");
    SQLite::Statement scores(impl_->database,
                             "SELECT outcome, metric, value FROM score_values ORDER BY outcome, metric");
    constexpr std::int64_t kNobody = std::numeric_limits<std::int64_t>::max();
    const auto next_score = [&] { return scores.executeStep() ? scores.getColumn(0).getInt64() : kNobody; };
    std::int64_t whose = next_score();
    std::vector<OutcomeView::Value> values;
    const auto text = [](SQLite::Statement& row, int column) {
      return std::string_view(row.getColumn(column).getText());
    };
    while (outcomes.executeStep()) {
      const std::int64_t id = outcomes.getColumn(0).getInt64();
      while (whose < id) whose = next_score();
      values.clear();
      auto name = names.begin();
      for (; whose == id && id != kNobody; whose = next_score()) {
        const std::string_view metric = text(scores, 1);
        for (int ahead = 0; ahead < 2 && name != names.end() && *name < metric; ++ahead) ++name;
        if (name == names.end() || *name != metric) name = names.lower_bound(metric);
        if (name == names.end() || *name != metric) name = names.emplace_hint(name, metric);
        values.push_back(
            {&*name, stored_value(scores.getColumn(2), impl_->path, [&] {
               return draw_text(outcomes.getColumn(1).getString(), read_seed(outcomes.getColumn(2).getInt64())) + ", " +
                      outcomes.getColumn(3).getString() + "/" + outcomes.getColumn(4).getString() + ", " + *name;
             })});
      }
      visit({text(outcomes, 1), read_seed(outcomes.getColumn(2).getInt64()),
             stored_kind(outcomes.getColumn(3).getString(), impl_->path), text(outcomes, 4),
             stored_status(outcomes.getColumn(5).getString(), impl_->path), text(outcomes, 6),
             outcomes.getColumn(7).getDouble(), values});
    }
  });
}

std::vector<Outcome> Results::outcomes(Rows rows) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kOutcomes) + picked(rows) + kInOrder);
    return read_outcomes(select, impl_->path);
  });
}

std::vector<Outcome> Results::outcomes_of(const std::string& scenario, std::uint64_t seed) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kOutcomes) + "scenario = ? AND seed = ?" + kInOrder);
    select.bind(1, scenario);
    select.bind(2, stored_seed(seed));
    return read_outcomes(select, impl_->path);
  });
}

std::vector<RejectedDraw> Results::rejected(Rows rows) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kRejections) + picked(rows) + kInOrder);
    return read_rejected(select);
  });
}

std::vector<RejectedDraw> Results::rejected_of(const std::string& scenario, std::uint64_t seed) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kRejections) + "scenario = ? AND seed = ?" + kInOrder);
    select.bind(1, scenario);
    select.bind(2, stored_seed(seed));
    return read_rejected(select);
  });
}

std::vector<DrawValues> Results::draws(Rows rows) const {
  return impl_->guarded([&] {
    std::vector<DrawValues> draws;
    const char* order = rows == Rows::plain ? " ORDER BY scenario, seed, varied, setting, metric"
                                            : " ORDER BY varied, setting, scenario, seed, metric";
    SQLite::Statement select(
        impl_->database, std::string("SELECT scenario, seed, metric, value, varied, setting FROM draw_values WHERE ") +
                             picked(rows) + order);
    while (select.executeStep()) {
      const std::string_view scenario = select.getColumn(0).getText(), varied = select.getColumn(4).getText();
      const std::uint64_t seed = read_seed(select.getColumn(1).getInt64());
      const double setting = select.getColumn(5).getDouble();
      if (draws.empty() || draws.back().seed != seed || draws.back().scenario != scenario ||
          draws.back().setting.key != varied || draws.back().setting.value != setting) {
        draws.push_back({std::string(scenario), seed, {}, {std::string(varied), setting}});
      }
      draws.back().values.push_back({select.getColumn(2).getText(), 0.0});
      Score& score = draws.back().values.back();
      score.value = stored_value(select.getColumn(3), impl_->path,
                                 [&] { return draw_text(draws.back().scenario, seed) + ", " + score.metric; });
    }
    return draws;
  });
}

std::map<std::string, std::string> Results::notes() const {
  return impl_->guarded([&] {
    std::map<std::string, std::string> notes;
    SQLite::Statement select(impl_->database, "SELECT key, text FROM notes");
    while (select.executeStep()) notes.emplace(select.getColumn(0).getString(), select.getColumn(1).getString());
    return notes;
  });
}

std::vector<Certificate> Results::certificates() const {
  return impl_->guarded([&] {
    std::vector<Certificate> certificates;
    SQLite::Statement select(impl_->database,
                             "SELECT build, row, subject, law, unit, value, low, high, note FROM certificates "
                             "ORDER BY build, number");
    while (select.executeStep()) {
      const std::string build = select.getColumn(0).getString();
      if (certificates.empty() || certificates.back().build != build) certificates.push_back({build, {}});
      const auto text = [&](int column) { return select.getColumn(column).getString(); };
      const auto value = [&](int column) {
        return stored_value(select.getColumn(column), impl_->path, [&] { return "certificate, " + text(1); });
      };
      certificates.back().entries.push_back(
          {text(1), text(2), text(3), text(4), value(5), value(6), value(7), text(8)});
    }
    return certificates;
  });
}

}  // namespace tumble::scenarios
