// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios::hdf5 {

/// Opens every object and attribute of an HDF5 file in a child process, because HDF5 1.10 may crash on damaged files.
/// The cost of opening all objects is O(number of objects); dataset contents are not read.
void require_survivable(const std::filesystem::path& path);

}  // namespace tumble::scenarios::hdf5
