// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "scenarios/recordings/clouds/cloud_file.hpp"

namespace tumble::scenarios {

/// Reads a legacy VTK text file. The section POINTS, and each section SCALARS with one number per point, become named
/// columns; other sections are skipped.
///
/// The number of points must be at most 2^26, and must agree with the file size.
Cloud read_vtk(const std::filesystem::path& path);

}  // namespace tumble::scenarios
