// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Throws BadInput if `path` is not a regular file. Throws BadInput also for a folder, bag, table or other file that
/// `tumble import` converts to a recording. The message contains the import command. The function reads the first 16
/// bytes and the extension.
void require_recording_file(const std::filesystem::path& path);

}  // namespace tumble::scenarios
