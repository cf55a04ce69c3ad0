// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "stand_ins/known_motion.hpp"
#include "stand_ins/stand_ins.hpp"
#include "stand_ins/writers.hpp"

namespace tumble::test {

namespace {

constexpr int kRings = 16, kColumns = 150;
constexpr double kSweep_s = 0.1;
constexpr long long kStart_s = 1690309709, kStart_ns = 285305600;

/// Returns the vector from the lidar to the wall of the room, in the lidar's axes.
Eigen::Vector3d hit(const Eigen::Isometry3d& T_WL, const Eigen::Vector3d& ray_L) {
  const Eigen::Vector3d ray_W = T_WL.linear() * ray_L, from = T_WL.translation();
  double nearest_m = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double wall_m = ray_W[axis] > 0.0 ? kNorlabRoom_m[static_cast<std::size_t>(axis)]
                                            : -kNorlabRoom_m[static_cast<std::size_t>(axis)];
    if (ray_W[axis] != 0.0) nearest_m = std::min(nearest_m, (wall_m - from[axis]) / ray_W[axis]);
  }
  return ray_L * nearest_m;
}

void write_sweep(const std::filesystem::path& file, double start_s) {
  std::string points, vertices, intensity, times;
  char line[120];
  for (int column = 0; column < kColumns; ++column) {
    for (int ring = 0; ring < kRings; ++ring) {
      const double offset_s = kSweep_s * (column + ring / 20.0) / kColumns;
      const double azimuth = 2.0 * M_PI * column / kColumns, elevation = (ring - 7.5) * 0.035;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const Eigen::Vector3d p = hit(norlab_pose(start_s + offset_s), ray);
      std::snprintf(line, sizeof line, "%12.6g %12.6g %12.6g\n", p.x(), p.y(), p.z());
      points += line;
      std::snprintf(line, sizeof line, "1 %d\n", column * kRings + ring);
      vertices += line;
      std::snprintf(line, sizeof line, "%3d\n", (column + ring) % 256);
      intensity += line;
      std::snprintf(line, sizeof line, "%10.6g\n", offset_s * 1e9);
      times += line;
    }
  }
  const std::string count = std::to_string(kRings * kColumns);
  std::ofstream out(file, std::ios::binary);
  out << "# vtk DataFile Version 3.0\nFile created by libpointmatcher\nASCII\nDATASET POLYDATA\nPOINTS " << count
      << " float\n"
      << points << "VERTICES " << count << " " << 2 * kRings * kColumns << "\n"
      << vertices << "POINT_DATA " << count << "\nSCALARS intensity float\nLOOKUP_TABLE default\n"
      << intensity << "SCALARS t float\nLOOKUP_TABLE default\n"
      << times;
  if (!out.flush()) throw std::runtime_error("cannot write a sweep");
}

void write_poses(const std::filesystem::path& file, double deviation_m) {
  std::ofstream out(file, std::ios::binary);
  out << "header.stamp.sec,header.stamp.nanosec,header.frame_id,child_frame_id,pose.pose.position.x,"
         "pose.pose.position.y,pose.pose.position.z,pose.pose.orientation.x,pose.pose.orientation.y,"
         "pose.pose.orientation.z,pose.pose.orientation.w,pose.covariance\n";
  Noise noise(20230725);
  for (int k = 0; k < kNorlabSweeps; ++k) {
    const Eigen::Isometry3d T = norlab_pose(kSweep_s * k);
    const Eigen::Quaterniond q(T.linear());
    const Eigen::Vector3d p = T.translation() + noise.vector(deviation_m);
    char line[400];
    std::snprintf(line, sizeof line, "%lld,%lld,map,base_link,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,[0. 0. 0.]\n",
                  kStart_s, kStart_ns + 100000000LL * k, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    out << line;
  }
  if (!out.flush()) throw std::runtime_error("cannot write the poses");
}

}  // namespace

Eigen::Isometry3d norlab_pose(double t_s) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.4 * t_s, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.3 * t_s, 0.1 * t_s, 0.0);
  return T;
}

void write_norlab(const std::filesystem::path& folder) {
  for (int k = 0; k < kNorlabSweeps; ++k) {
    char name[60];
    std::snprintf(name, sizeof name, "cloud_%lld_%09lld.vtk", kStart_s, kStart_ns + 100000000LL * k);
    write_sweep(folder / name, kSweep_s * k);
  }
  write_poses(folder / "trajectory.csv", 0.0);
  write_poses(folder / "icp_odom.csv", 0.005);
}

}  // namespace tumble::test
