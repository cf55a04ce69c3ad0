// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios::hdf5 {

/// Opens every object and attribute of an HDF5 file once in a child process, to detect files that crash HDF5. HDF5 1.10
/// may read out of bounds and crash on damaged files; then only the child process crashes. The cost is proportional to
/// the number of objects, because the contents of datasets are not read. Throws BadInput if the child process crashes.
/// Other errors are ignored here, because the reader reports them. Out-of-bounds reads that do not crash are not
/// detected.
void require_survivable(const std::filesystem::path& path);

}  // namespace tumble::scenarios::hdf5
