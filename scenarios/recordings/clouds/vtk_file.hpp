// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "scenarios/recordings/clouds/cloud_file.hpp"

namespace tumble::scenarios {

/// Reads the points of a legacy VTK text file of polygonal data, the format of libpointmatcher. Reads POINTS, and
/// SCALARS of one number per point as named columns; skips vertices, vectors, normals, tensors, colours and other
/// scalars. Private to scenarios/recordings/clouds.
///
/// Throws BadInput with file and line: missing, not such a file, binary, another section, or an invalid number. Also
/// throws for more points than the file can hold or than 2^26, truncated numbers, or point data of another length than
/// the points.
Cloud read_vtk(const std::filesystem::path& path);

}  // namespace tumble::scenarios
