// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <tumble/pcl/map_cloud.hpp>

int main() {
  const std::vector<tumble::MapPoint> map(3);
  std::printf("%zu points\n", tumble::to_pcl(map).size());
}
