// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios::hdf5 {

/// Opens every object and attribute of a file once in a child process. HDF5 1.10 may read out of bounds on damaged
/// files and crash; then only the child crashes. Dataset contents are not read, and the cost is proportional to the
/// number of objects. Throws BadInput if the child dies. Ordinary errors are not reported, because the reader reports
/// them. Out-of-bounds reads without a crash are not detected.
void require_survivable(const std::filesystem::path& path);

}  // namespace tumble::scenarios::hdf5
