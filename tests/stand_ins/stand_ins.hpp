// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// The simulated recordings replace the real ones: files in the sources' own formats, some seconds long, of motions
/// that are known in closed form, so that every test on real recordings runs in every clone. They test formats,
/// conventions and whether a method works on a motion like the real one; only the real files show how accurate it is on
/// real devices, and the same tests read those too where they are available.
namespace tumble::test {

/// A DataFolder is what a test reads: the simulated files of a source or the source itself.
struct DataFolder {
  std::filesystem::path path;
  bool real = false;
};

/// Returns the folders of a source ("broad", "norlab", "repoimu", "sphere_log"): always the simulated one,
/// and after it the real one where it is available. The function writes no files; `written` does.
std::vector<DataFolder> data_folders(const std::string& source);
/// FolderName names a test's parameter: "stand_in", "real".
struct FolderName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return info.param.real ? "real" : "stand_in";
  }
};

/// Writes the simulated files of the folder unless this process has already done so; real folders remain unchanged.
/// Returns the folder's path. The files have the same bytes on every machine.
std::filesystem::path written(const DataFolder& folder);

// The constants below name the simulated files and what is known of them.

/// kStandInTrial is the number of the simulated trial of BROAD (its name begins with it).
inline constexpr const char* kStandInTrial = "00";
inline constexpr std::size_t kStandInTrialSamples = 25714;
/// kStandInWand is a wand whose gyro is saturated about x at the tilted saturation plane that TStick_Test05 of RepoIMU
/// shows.
inline constexpr const char* kStandInWand = "TStick_StandIn.csv";
inline constexpr const char* kSphereLogFile = "orientation_all.csv";
inline constexpr std::size_t kStandInSphereSamples = 3751;
/// kStandInSphereNet_m is the distance between the first and the last position of the simulated rolling sphere.
inline constexpr double kStandInSphereNet_m = 3.0;

/// The next two constants and norlab_pose describe norlab's sweeps: their number, half the room's sides, and the
/// lidar's pose at a time after the first sweep's start.
inline constexpr int kNorlabSweeps = 6;
inline constexpr std::array<double, 3> kNorlabRoom_m = {6.0, 4.0, 1.5};
Eigen::Isometry3d norlab_pose(double t_s);

/// WandRail is the saturation plane of the real wand: x = +-distance + offset + y_slope y + z_slope z.
struct WandRail {
  double distance_rad_s = 7.2987, offset_rad_s = -0.046, y_slope = 0.006, z_slope = -0.0181;
};
/// Returns how many samples of the simulated wand are saturated, counted on the motion itself.
int stand_in_wand_clipped();

}  // namespace tumble::test
