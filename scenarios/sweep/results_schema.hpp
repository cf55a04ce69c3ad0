// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace SQLite {
class Database;
}

namespace tumble::scenarios {

/// kApplicationId is the application id in the SQLite header ("TMBL"), by which the program recognises its databases.
inline constexpr int kApplicationId = 0x544d424c;
inline constexpr int kSchemaVersion = 4;
/// kReadableVersion is an older version of the schema that the program can still read. The older version differs from
/// the current version only in the allowed statuses.
inline constexpr int kReadableVersion = 3;

/// kSchema is the SQL text that creates an empty results database.
extern const char* const kSchema;

/// Returns the first table, column or view that the database lacks, for example "table score_values". Returns an empty
/// text if the schema is complete. Throws SQLite::Exception if the database cannot be read.
std::string missing_of_schema(const SQLite::Database& database);

}  // namespace tumble::scenarios
