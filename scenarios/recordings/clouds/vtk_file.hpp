// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "scenarios/recordings/clouds/cloud_file.hpp"

namespace tumble::scenarios {

/// Reads the points of a legacy VTK text file of polygonal data, the format of libpointmatcher. Reads POINTS, and
/// SCALARS with one number per point as named columns; skips vertices, vectors, normals, tensors, colours and other
/// scalars. Used only within scenarios/recordings/clouds.
///
/// Throws BadInput with file and line if the file is missing, binary, not polygonal data, has an unknown section, or
/// contains an invalid number. Also throws for more points than the file can contain or than 2^26, truncated numbers,
/// or point data whose length differs from the number of points.
Cloud read_vtk(const std::filesystem::path& path);

}  // namespace tumble::scenarios
