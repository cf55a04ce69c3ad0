// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace SQLite {
class Database;
}

namespace tumble::scenarios {

/// Application id in the SQLite header ("TMBL"), by which the program recognises its databases
inline constexpr int kApplicationId = 0x544d424c;
inline constexpr int kSchemaVersion = 4;
/// Older schema version that differs from the current version only in the allowed statuses
inline constexpr int kReadableVersion = 3;

extern const char* const kSchema;

std::string missing_of_schema(const SQLite::Database& database);

}  // namespace tumble::scenarios
