// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios::hdf5 {

/// Opens every object and every attribute of a file once in a child process. HDF5 1.10 trusts much of what a file says
/// of itself and reads beyond its own memory where that is damaged: then the child ends and not the caller. Numbers are
/// not read: O(objects). Throws BadInput when the library does not survive the file; what it complains of in good order
/// is left to who reads. A reading beyond memory that happens to end nothing is not seen.
void require_survivable(const std::filesystem::path& path);

}  // namespace tumble::scenarios::hdf5
