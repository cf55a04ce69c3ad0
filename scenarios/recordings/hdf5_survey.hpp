// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios::hdf5 {

/// Opens every object and attribute of a file once in a child process. On damaged files, HDF5 1.10 may read out of
/// bounds and crash; then only the child process crashes. The contents of datasets are not read, so the cost is
/// proportional to the number of objects. Throws BadInput if the child process crashes. Ordinary errors are ignored
/// here, because the reader reports them. Out-of-bounds reads without a crash are not detected.
void require_survivable(const std::filesystem::path& path);

}  // namespace tumble::scenarios::hdf5
