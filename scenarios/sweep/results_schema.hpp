// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace SQLite {
class Database;
}

namespace tumble::scenarios {

/// Marks a results database in SQLite's header ("TMBL"), so that another program's file is never written to.
inline constexpr int kApplicationId = 0x544d424c;
inline constexpr int kSchemaVersion = 4;
/// Differs in the statuses that it allows alone: it may still be read.
inline constexpr int kReadableVersion = 3;

/// Statements that make an empty results database.
extern const char* const kSchema;

/// The first table, column or view of the schema that a results database does not have, as "table score_values"; empty
/// where it has all. Throws SQLite::Exception.
std::string missing_of_schema(const SQLite::Database& database);

}  // namespace tumble::scenarios
