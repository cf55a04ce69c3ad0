// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Throws BadInput unless `path` is a regular file that may be HDF5 by its first 16 bytes and its extension.
void require_recording_file(const std::filesystem::path& path);

}  // namespace tumble::scenarios
