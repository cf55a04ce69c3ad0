// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <filesystem>

namespace tumble::scenarios {

/// Formats that PCL reads for us.
enum class PclFormat : int { ply, pcd };

/// What the module `pcl_reader_module.cpp` is: reads the points of a file, and says nothing on the console. False when
/// PCL does not read it, whatever it throws.
extern "C" using PclRead = bool(const char* path, PclFormat format, pcl::PCLPointCloud2* cloud);
inline constexpr const char* kPclRead = "tumble_pcl_read";  ///< its name there

/// That of the module, which is loaded at the first file and stays: PCL's readers bring VTK and sixty libraries more
/// with them, for which no program that reads no cloud is to wait. It lies in ../lib/tumble beside the folder of the
/// program, or where it was built. Throws BadInput when it cannot be loaded. Private to scenarios/recordings/clouds.
bool read_by_pcl(const std::filesystem::path& path, PclFormat format, pcl::PCLPointCloud2& cloud);

}  // namespace tumble::scenarios
