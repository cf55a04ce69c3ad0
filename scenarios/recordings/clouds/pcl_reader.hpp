// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <filesystem>

namespace tumble::scenarios {

enum class PclFormat : int { ply, pcd };

extern "C" using PclRead = bool(const char* path, PclFormat format, pcl::PCLPointCloud2* cloud);
inline constexpr const char* kPclRead = "tumble_pcl_read";  ///< symbol name of PclRead

/// Reads a point cloud by PCL. At first use, the program loads the module `pcl_reader_module.cpp` from ../lib/tumble
/// relative to the program's folder, or from the build folder. Without a separate module, PCL's readers would load VTK
/// and more than sixty libraries at every start of the program.
bool read_by_pcl(const std::filesystem::path& path, PclFormat format, pcl::PCLPointCloud2& cloud);

}  // namespace tumble::scenarios
