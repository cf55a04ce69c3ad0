// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <exception>
#include <type_traits>

#include "scenarios/recordings/clouds/pcl_reader.hpp"
#include "scenarios/recordings/clouds/quiet_pcl.hpp"

extern "C" bool tumble_pcl_read(const char* path, tumble::scenarios::PclFormat format, pcl::PCLPointCloud2* cloud) {
  using tumble::scenarios::PclFormat;
  const tumble::scenarios::QuietPcl quiet;
  try {
    return (format == PclFormat::ply ? pcl::PLYReader().read(path, *cloud) : pcl::PCDReader().read(path, *cloud)) >= 0;
  } catch (const std::exception&) {
    return false;
  }
}

static_assert(
    std::is_same_v<decltype(tumble_pcl_read), tumble::scenarios::PclRead>,
    "tumble_pcl_read must have the type PclRead, because the program calls this function by the type PclRead");
