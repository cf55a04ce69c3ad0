// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <limits>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/outcome_status.hpp"

namespace tumble::scenarios {

/// A null in the results database becomes NaN; text or a blob, which SQLite would convert to 0, throws BadInput.
template <typename Row>
double stored_value(const SQLite::Column& column, const std::filesystem::path& path, const Row& row) {
  const int type = column.getType();
  if (type == SQLite::FLOAT || type == SQLite::INTEGER) return column.getDouble();
  if (type == SQLite::Null) return std::numeric_limits<double>::quiet_NaN();
  throw BadInput(path.string() + ": " + row() + ": is " + (type == SQLite::TEXT ? "text" : "a blob") +
                 "; it must be a number or null");
}

inline Kind stored_kind(const std::string& name, const std::filesystem::path& path) {
  if (const auto kind = kind_named(name)) return *kind;
  throw BadInput(path.string() + ": unknown kind '" + name + "'");
}

inline OutcomeStatus stored_status(const std::string& name, const std::filesystem::path& path) {
  if (const auto status = outcome_status_named(name)) return *status;
  throw BadInput(path.string() + ": unknown status '" + name + "'");
}

}  // namespace tumble::scenarios
