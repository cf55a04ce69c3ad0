// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "scenarios/recordings/clouds/cloud_file.hpp"

namespace tumble::scenarios {

/// Reads the points of a legacy VTK file of polygonal data written as text, as libpointmatcher saves its clouds:
/// POINTS, and SCALARS of one number a point as columns of their names; vertices, vectors, normals, tensors, colours
/// and scalars of several numbers are passed over. Private to scenarios/recordings/clouds. Throws BadInput with file
/// and line: absent, not such a file, binary, another section, a word that is no number, more points than the file has
/// room for or 2^26, numbers that end too early, another number of point data than of points.
Cloud read_vtk(const std::filesystem::path& path);

}  // namespace tumble::scenarios
