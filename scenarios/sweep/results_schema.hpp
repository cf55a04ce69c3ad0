// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace SQLite {
class Database;
}

namespace tumble::scenarios {

/// kApplicationId is the application id in SQLite's header ("TMBL"), so that databases of other programs are never
/// modified.
inline constexpr int kApplicationId = 0x544d424c;
inline constexpr int kSchemaVersion = 4;
/// kReadableVersion is an older schema version that is still readable. The older version differs from the current
/// version only in the allowed statuses.
inline constexpr int kReadableVersion = 3;

/// kSchema is the SQL text that creates an empty results database.
extern const char* const kSchema;

/// Returns the first missing table, column or view, for example "table score_values". Returns an empty text if the
/// schema is complete. Throws SQLite::Exception.
std::string missing_of_schema(const SQLite::Database& database);

}  // namespace tumble::scenarios
