// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <limits>
#include <string>

#include "scenarios/errors.hpp"

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

}  // namespace tumble::scenarios
