// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <limits>
#include <string>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

/// A number as results databases store it: null is NaN, which SQLite has not. Columns of SQLite take text and blobs
/// too, and would give these as 0: throws BadInput with the path and `row()`, which says whose value it is.
template <typename Row>
double stored_value(const SQLite::Column& column, const std::filesystem::path& path, const Row& row) {
  if (column.isNull()) return std::numeric_limits<double>::quiet_NaN();
  if (column.isFloat() || column.isInteger()) return column.getDouble();
  throw BadInput(path.string() + ": " + row() + ": is " + (column.isText() ? "text" : "a blob") +
                 ", must be a number or null");
}

}  // namespace tumble::scenarios
