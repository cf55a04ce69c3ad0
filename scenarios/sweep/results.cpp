// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <string_view>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/regular_file.hpp"
#include "scenarios/sweep/results_database.hpp"

namespace tumble::scenarios {

// Stores an outcome. SQLite stores the number NaN as null.
void Results::Impl::store(const std::string& kind, const Outcome& outcome) {
  Transaction transaction(*this);
  if (!kind.empty()) {
    SQLite::Statement drawn(database,
                            "DELETE FROM outcomes WHERE scenario = ? AND seed = ? AND kind = '' AND method = '' "
                            "AND varied = ? AND setting = ?");
    SQLite::bind(drawn, outcome.scenario, stored_seed(outcome.seed), outcome.setting.key, outcome.setting.value);
    drawn.exec();
  }
  SQLite::Statement insert(database,
                           "INSERT OR REPLACE INTO outcomes (scenario, seed, kind, method, status, message, "
                           "recording_digest, estimate_digest, varied, setting) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SQLite::bind(insert, outcome.scenario, stored_seed(outcome.seed), kind, outcome.method, to_string(outcome.status),
               outcome.message, outcome.recording_digest, outcome.estimate_digest, outcome.setting.key,
               outcome.setting.value);
  insert.exec();
  const std::int64_t id = database.getLastInsertRowid();
  SQLite::Statement value(database, "INSERT OR REPLACE INTO score_values VALUES (?, ?, ?)");
  for (const Score& score : outcome.scores) {
    if (score.metric.empty()) continue;
    SQLite::bind(value, id, score.metric, score.value);
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
      SQLite::bind(insert, draw.scenario, stored_seed(draw.seed), score.metric, score.value, draw.setting.key,
                   draw.setting.value);
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
      SQLite::bind(insert, certificate.build, static_cast<std::int64_t>(i), entry.row, entry.subject, entry.law,
                   entry.unit, entry.value, entry.low, entry.high, entry.note);
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
