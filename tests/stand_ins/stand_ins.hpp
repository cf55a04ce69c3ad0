// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Stand-ins for the real recordings: short files in the original formats, with closed-form motions, so that every test
/// on real recordings runs in every clone. Stand-ins test formats, conventions, and the behaviour of a method on a
/// similar motion. Only the real files show the accuracy on real devices; the same tests also read them if they are
/// available.
namespace tumble::test {

/// Data of a test: the stand-in of a source, or the source itself.
struct DataFolder {
  std::filesystem::path path;
  bool real = false;
};

/// Returns the folders of a source ("broad", "norlab", "repoimu", "airbrakes", "sphere_log"): the stand-in's, then the
/// real one's if it is available. The function `written` writes the files.
std::vector<DataFolder> data_folders(const std::string& source);
/// Returns only the real folder, if it is available.
std::vector<std::filesystem::path> published_folders(const std::string& source);
/// Returns the name of a test's parameter: "stand_in", "real".
struct FolderName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return info.param.real ? "real" : "stand_in";
  }
};

/// Writes the stand-in files of the folder if this process has not done so; real folders are unchanged. Returns the
/// path of the folder. The bytes are always identical.
std::filesystem::path written(const DataFolder& folder);

// Files of the stand-ins, and their known properties.

/// Number of the stand-in trial of BROAD, whose file name starts with it.
inline constexpr const char* kStandInTrial = "00";
inline constexpr std::size_t kStandInTrialSamples = 25714;
/// A wand whose gyro clips about x at a tilted saturation limit, as in TStick_Test05 of RepoIMU.
inline constexpr const char* kStandInWand = "TStick_StandIn.csv";
inline constexpr const char* kStandInFlight = "stand_in_flight.csv";
inline constexpr const char* kSphereLogFile = "orientation_all.csv";
inline constexpr std::size_t kStandInSphereSamples = 3751;
/// Distance between the first and the last position of the stand-in's rolling sphere.
inline constexpr double kStandInSphereNet_m = 3.0;

/// Properties of norlab's stand-in: number of sweeps, half the sides of the room, and the lidar's pose at a time after
/// the first sweep's start.
inline constexpr int kNorlabSweeps = 6;
inline constexpr std::array<double, 3> kNorlabRoom_m = {6.0, 4.0, 1.5};
Eigen::Isometry3d norlab_pose(double t_s);

/// Saturation limit of the real wand: x = +-distance + offset + y_slope y + z_slope z.
struct WandRail {
  double distance_rad_s = 7.2987, offset_rad_s = -0.046, y_slope = 0.006, z_slope = -0.0181;
};
/// Number of samples of the stand-in wand at this saturation limit, counted on the motion itself.
int stand_in_wand_clipped();

}  // namespace tumble::test
