// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace {

static_assert(std::endian::native == std::endian::little,
              "the exported PLY and PCD files are little-endian, so this code needs a little-endian processor");

std::string ply_header(std::size_t points, bool timed) {
  return "ply\nformat binary_little_endian 1.0\ncomment one lidar sweep, lidar axes, metres, not deskewed\nelement "
         "vertex " +
         std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nproperty ushort ring\n" +
         (timed ? "property uint offset_ns\n" : "") + "end_header\n";
}

std::string pcd_header(std::size_t points, bool timed) {
  const std::string count = std::to_string(points);
  const char* fields =
      timed ? "FIELDS x y z intensity ring offset_ns\nSIZE 4 4 4 4 2 4\nTYPE F F F F U U\nCOUNT 1 1 1 1 1 1"
            : "FIELDS x y z intensity ring\nSIZE 4 4 4 4 2\nTYPE F F F F U\nCOUNT 1 1 1 1 1";
  return std::string("# .PCD v0.7 - one lidar sweep, lidar axes, metres, not deskewed\nVERSION 0.7\n") + fields +
         "\nWIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
}

template <class Number>
void append_bytes(std::string& out, const Number& number) {
  out.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

void append_points(std::string& out, const sim::LidarRecord& lidar, std::size_t first, std::size_t end) {
  out.reserve(out.size() + (end - first) * 22);
  for (std::size_t i = first; i < end; ++i) {
    for (const float x : lidar.position_L_m[i]) append_bytes(out, x);
    append_bytes(out, lidar.intensity[i]);
    append_bytes(out, lidar.ring[i]);
    if (has_timed_points(lidar)) append_bytes(out, lidar.offset_ns[i]);
  }
}

void export_sweeps(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns,
                   const char* extension, std::string (*header)(std::size_t, bool)) {
  if (sensors.lidars.empty()) throw BadInput("the recording has no lidar, so there are no sweeps to export");
  const std::vector<std::string> stems = export_names(sensors).lidars.names;
  OutputFolder output(folder);
  for (std::size_t k = 0; k < sensors.lidars.size(); ++k) {
    const sim::LidarRecord& lidar = sensors.lidars[k];
    const std::string& stem = stems[k];
    std::string times = "# start of each sweep [s]\n";
    for (std::size_t sweep = 0; sweep < lidar.sweep_start_ns.size(); ++sweep) {
      const std::size_t first = lidar.sweep_first[sweep];
      const std::size_t end = lidar.sweep_first[sweep + 1];
      append_seconds(times, origin_ns + lidar.sweep_start_ns[sweep]);
      times += '\n';
      std::string bytes = header(end - first, has_timed_points(lidar));
      append_points(bytes, lidar, first, end);
      const std::string number = std::to_string(sweep);
      const std::string padding(number.size() < 6 ? 6 - number.size() : 0, '0');
      replace_file(folder / (stem + "_" + padding + number + extension), bytes);
    }
    replace_file(folder / (stem + "_times.txt"), times);
  }
  output.keep();
}

}  // namespace

void export_ply(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns) {
  export_sweeps(sensors, folder, origin_ns, ".ply", ply_header);
}

void export_pcd(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns) {
  export_sweeps(sensors, folder, origin_ns, ".pcd", pcd_header);
}

}  // namespace tumble::scenarios
