// SPDX-License-Identifier: BSD-3-Clause
#include "stand_ins/stand_ins.hpp"

#include <unistd.h>

#include <fstream>
#include <map>
#include <stdexcept>

#include "stand_ins/synthetic_repoimu.hpp"
#include "stand_ins/writers.hpp"
#include "tests/tree.hpp"

namespace tumble::test {

namespace fs = std::filesystem;

namespace {

using Writer = void (*)(const fs::path&);

const std::map<std::string, Writer>& writers() {
  static const std::map<std::string, Writer> all = {
      {"broad", write_broad}, {"norlab", write_norlab}, {"repoimu", write_repoimu}, {"sphere_log", write_sphere_log}};
  return all;
}

/// Root is the folder of this process, which removes it at its end.
class Root {
 public:
  Root() : path_(fs::temp_directory_path() / ("tumble_stand_ins_" + std::to_string(getpid()))), owner_(getpid()) {}
  ~Root() {
    std::error_code ignored;
    if (owner_ == getpid()) fs::remove_all(path_, ignored);
  }
  Root(const Root&) = delete;
  Root& operator=(const Root&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  pid_t owner_;
};

const fs::path& root() {
  static const Root root;
  return root.path();
}

}  // namespace

std::vector<DataFolder> data_folders(const std::string& source) {
  if (!writers().contains(source)) throw std::runtime_error("no stand-in of " + source);
  std::vector<DataFolder> folders = {{root() / source, false}};
  const fs::path real = shared_data() / source;
  if (fs::is_directory(real)) folders.push_back({real, true});
  return folders;
}

fs::path written(const DataFolder& folder) {
  if (folder.real || fs::exists(folder.path)) return folder.path;
  fs::create_directories(folder.path);
  writers().at(folder.path.filename().string())(folder.path);
  return folder.path;
}

namespace {

scenarios::fixture::Wand stand_in_wand() {
  scenarios::fixture::Wand wand;
  wand.duration_s = 120.0;
  const WandRail rail;
  wand.rail_rad_s = rail.distance_rad_s;
  wand.rail_offset_rad_s = rail.offset_rad_s;
  wand.rail_y_slope = rail.y_slope;
  wand.rail_tilt = rail.z_slope;
  wand.flips_s = {31.0, 77.0};
  return wand;
}

}  // namespace

int stand_in_wand_clipped() {
  const scenarios::fixture::Wand wand = stand_in_wand();
  int count = 0;
  for (int k = 0; k < static_cast<int>(wand.duration_s * wand.log_hz); ++k) {
    const Eigen::Vector3d w = scenarios::fixture::Wand::rate(k / wand.log_hz);
    count += scenarios::fixture::clipped(wand, w) != w ? 1 : 0;
  }
  return count;
}

void write_repoimu(const fs::path& folder) {
  std::ofstream(folder / kStandInWand) << scenarios::fixture::repoimu_text(stand_in_wand());
}

}  // namespace tumble::test
