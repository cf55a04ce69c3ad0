// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace tumble::scenarios {

/// Puts `bytes` into a file: written under a temporary name in the same folder, flushed to the disk, then renamed, so
/// that the path holds the old file or the whole new one. Throws BadInput with the path and the system's reason (no
/// such folder, no permission, disk full); the temporary file is then removed.
void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void replace_file(const std::filesystem::path& path, std::string_view text);

}  // namespace tumble::scenarios
