// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <filesystem>

namespace tumble::scenarios {

/// PclFormat lists the file formats that PCL reads.
enum class PclFormat : int { ply, pcd };

/// PclRead is the function of the module `pcl_reader_module.cpp` that reads the points of a file without console
/// output. Returns false if PCL fails or throws.
extern "C" using PclRead = bool(const char* path, PclFormat format, pcl::PCLPointCloud2* cloud);
inline constexpr const char* kPclRead = "tumble_pcl_read";  ///< symbol name of PclRead

/// Reads the points of a file with the module `pcl_reader_module.cpp`, which is loaded at first use from ../lib/tumble
/// relative to the program's folder, or from the build folder. PCL's readers load VTK and more than sixty libraries,
/// which would slow every start of the program without the module. Throws BadInput if the module cannot be loaded.
bool read_by_pcl(const std::filesystem::path& path, PclFormat format, pcl::PCLPointCloud2& cloud);

}  // namespace tumble::scenarios
