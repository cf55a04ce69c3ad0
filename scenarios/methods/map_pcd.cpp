// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <exception>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/methods/map_file.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/clouds/quiet_pcl.hpp"
#include "tumble/pcl/map_cloud.hpp"

namespace tumble::scenarios {

void write_pcd_map(const std::filesystem::path& path, std::span<const MapPoint> map) {
  if (map.empty()) throw BadInput(path.string() + ": a PCD file holds one point at least");
  const QuietPcl quiet;
  int status = -1;
  try {
    status = pcl::io::savePCDFileBinary(path.string(), to_pcl(map));
  } catch (const pcl::PCLException&) {  // the status says so
  }
  if (status != 0) throw BadInput(path.string() + ": cannot be written");
}

std::vector<MapPoint> read_pcd_map(const std::filesystem::path& path) {
  // the library trusts the header, and reads an empty file's
  if (read_pcd_header(path).points == 0) throw BadInput(path.string() + ": a map holds one point at least");
  const QuietPcl quiet;
  pcl::PCDReader reader;
  pcl::PCLPointCloud2 blob;
  int status = -1;
  try {
    status = reader.read(path.string(), blob);
  } catch (const std::exception&) {  // the status says so
  }
  if (status != 0) throw BadInput(path.string() + ": cannot be read as PCD: absent, damaged or truncated");
  for (const char* name : {"x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity"}) {
    const auto has = [&](const pcl::PCLPointField& field) { return field.name == name; };
    if (std::none_of(blob.fields.begin(), blob.fields.end(), has)) {
      throw BadInput(path.string() + ": no field '" + name + "' in it");
    }
  }
  pcl::PointCloud<pcl::PointXYZINormal> cloud;
  pcl::fromPCLPointCloud2(blob, cloud);
  return from_pcl(cloud);
}

}  // namespace tumble::scenarios
