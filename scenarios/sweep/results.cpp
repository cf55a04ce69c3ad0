// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/regular_file.hpp"
#include "scenarios/sweep/results_database.hpp"

namespace tumble::scenarios {

namespace {

void bind_value(SQLite::Statement& statement, int index, double value) {
  if (std::isnan(value))
    statement.bind(index);
  else
    statement.bind(index, value);
}

}  // namespace

void Results::Impl::store(const std::string& kind, const Outcome& outcome) {
  Transaction transaction(*this);
  if (!kind.empty()) {
    SQLite::Statement drawn(database,
                            "DELETE FROM outcomes WHERE scenario = ? AND seed = ? AND kind = '' AND method = '' "
                            "AND varied = ? AND setting = ?");
    drawn.bind(1, outcome.scenario);
    drawn.bind(2, stored_seed(outcome.seed));
    drawn.bind(3, outcome.setting.key);
    drawn.bind(4, outcome.setting.value);
    drawn.exec();
  }
  SQLite::Statement insert(database,
                           "INSERT OR REPLACE INTO outcomes (scenario, seed, kind, method, status, message, "
                           "recording_digest, estimate_digest, varied, setting) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, outcome.scenario);
  insert.bind(2, stored_seed(outcome.seed));
  insert.bind(3, kind);
  insert.bind(4, outcome.method);
  insert.bind(5, std::string(to_string(outcome.status)));
  insert.bind(6, outcome.message);
  insert.bind(7, outcome.recording_digest);
  insert.bind(8, outcome.estimate_digest);
  insert.bind(9, outcome.setting.key);
  insert.bind(10, outcome.setting.value);
  insert.exec();
  const std::int64_t id = database.getLastInsertRowid();
  SQLite::Statement value(database, "INSERT OR REPLACE INTO score_values VALUES (?, ?, ?)");
  for (const Score& score : outcome.scores) {
    if (score.metric.empty()) continue;
    value.bind(1, id);
    value.bind(2, score.metric);
    bind_value(value, 3, score.value);
    value.exec();
    value.reset();
  }
  transaction.commit();
}

Results::Results(const std::filesystem::path& path, Mode mode) {
  std::error_code ignored;
  const std::filesystem::file_status found = std::filesystem::status(path, ignored);
  if (mode == Mode::read_only || std::filesystem::exists(found)) require_regular_file(path);
  try {
    impl_ = std::make_unique<Impl>(path, mode);
    if (mode != Mode::read_only && impl_->is_empty()) impl_->create();
    impl_->check(mode);
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() == kSqliteBusy) throw BadInput(path.string() + ": " + kBusy);
    throw BadInput(fmt::format("{}: the file is not a usable results database: {}", path.string(), error.what()));
  }
}

Results::~Results() = default;
Results::Results(Results&&) noexcept = default;

void Results::store(const Outcome& outcome) {
  impl_->guarded([&] { impl_->store(to_string(outcome.kind), outcome); });
}

bool Results::store(const RejectedDraw& rejected) {
  for (const Outcome& held : outcomes_of(rejected.scenario, rejected.seed)) {
    if (held.setting == rejected.setting) return false;
  }
  Outcome outcome;
  outcome.scenario = rejected.scenario;
  outcome.seed = rejected.seed;
  outcome.status = OutcomeStatus::rejected;
  outcome.message = rejected.message;
  outcome.setting = rejected.setting;
  impl_->guarded([&] { impl_->store("", outcome); });
  return true;
}

void Results::store(const DrawValues& draw) {
  impl_->guarded([&] {
    Impl::Transaction transaction(*impl_);
    SQLite::Statement insert(impl_->database, "INSERT OR REPLACE INTO draw_values VALUES (?, ?, ?, ?, ?, ?)");
    for (const Score& score : draw.values) {
      insert.bind(1, draw.scenario);
      insert.bind(2, stored_seed(draw.seed));
      insert.bind(3, score.metric);
      bind_value(insert, 4, score.value);
      insert.bind(5, draw.setting.key);
      insert.bind(6, draw.setting.value);
      insert.exec();
      insert.reset();
    }
    transaction.commit();
  });
}

void Results::store(const Certificate& certificate) {
  impl_->guarded([&] {
    Impl::Transaction transaction(*impl_);
    SQLite::Statement remove(impl_->database, "DELETE FROM certificates WHERE build = ?");
    remove.bind(1, certificate.build);
    remove.exec();
    SQLite::Statement insert(impl_->database, "INSERT INTO certificates VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (std::size_t i = 0; i < certificate.entries.size(); ++i) {
      const CertificateEntry& entry = certificate.entries[i];
      insert.bind(1, certificate.build);
      insert.bind(2, static_cast<std::int64_t>(i));
      insert.bind(3, entry.row);
      insert.bind(4, entry.subject);
      insert.bind(5, entry.law);
      insert.bind(6, entry.unit);
      bind_value(insert, 7, entry.value);
      bind_value(insert, 8, entry.low);
      bind_value(insert, 9, entry.high);
      insert.bind(10, entry.note);
      insert.exec();
      insert.reset();
    }
    transaction.commit();
  });
}

void Results::set_note(const std::string& key, const std::string& text) {
  impl_->guarded([&] { impl_->write_note(key, text); });
}

namespace {

constexpr std::string_view kMethodNote = "method ";

}  // namespace

std::string method_note(Kind kind, const std::string& name) {
  return std::string(kMethodNote) + to_string(kind) + "/" + name;
}

bool is_method_note(const std::string& key) {
  return key.starts_with(kMethodNote);
}

std::string Results::note(const std::string& key) const {
  return impl_->guarded([&] { return impl_->read_note(key); });
}

void Results::in_one_transaction(const std::function<void()>& work) {
  impl_->guarded([&] {
    SQLite::Transaction transaction(impl_->database, SQLite::TransactionBehavior::IMMEDIATE);
    impl_->in_transaction = true;
    try {
      work();
    } catch (...) {
      impl_->in_transaction = false;
      throw;
    }
    impl_->in_transaction = false;
    transaction.commit();
  });
}

}  // namespace tumble::scenarios
