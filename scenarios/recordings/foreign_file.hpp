// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Throws BadInput if `path` is not a regular file that may be a recording, judged by its first 16 bytes and its
/// extension. For a folder, bag, table or other file that can be imported, the message contains the `tumble import`
/// command.
void require_recording_file(const std::filesystem::path& path);

}  // namespace tumble::scenarios
