// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Throws BadInput if `path` is not a regular file that may be a recording. A folder, bag, table or other file that
/// `tumble import` can convert also throws BadInput. For a file that can be imported, the message contains the import
/// command. The function checks the first 16 bytes and the extension of the file.
void require_recording_file(const std::filesystem::path& path);

}  // namespace tumble::scenarios
