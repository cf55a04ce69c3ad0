// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace SQLite {
class Database;
}

namespace tumble::scenarios {

/// Application id in the SQLite header ("TMBL"), by which the program recognises its databases.
inline constexpr int kApplicationId = 0x544d424c;
inline constexpr int kSchemaVersion = 4;
/// Older version of the schema that the program can read; it differs from the current version only in the allowed
/// statuses.
inline constexpr int kReadableVersion = 3;

/// SQL text that creates an empty results database.
extern const char* const kSchema;

/// Returns the first table, column or view that the database lacks, for example "table score_values"; empty if the
/// schema is complete. Throws SQLite::Exception if the database cannot be read.
std::string missing_of_schema(const SQLite::Database& database);

}  // namespace tumble::scenarios
