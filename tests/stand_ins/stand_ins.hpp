// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Stand-ins for the real recordings: files in the sources' own formats, some seconds long, of motions that are known
/// in closed form, so that every test on real recordings runs in every clone. They prove formats, conventions and that
/// a method does what it must on a motion like the real one; how good it is on real devices only the real files say,
/// which the same tests read in addition where they are there.
namespace tumble::test {

/// What a test reads: the stand-in of a source or the source itself.
struct DataFolder {
  std::filesystem::path path;
  bool real = false;
};

/// The folders of a source ("broad", "norlab", "repoimu", "airbrakes", "sphere_log"): always the stand-in's, and the
/// real one's after it where it is there. Nothing is written yet; `written` does it.
std::vector<DataFolder> data_folders(const std::string& source);
/// The real one alone, where it is there.
std::vector<std::filesystem::path> published_folders(const std::string& source);
/// Names a test's parameter: "stand_in", "real".
struct FolderName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return info.param.real ? "real" : "stand_in";
  }
};

/// Writes the stand-in files of the folder when that was not done in this process; real folders stay as they are.
/// Returns the folder's path. Deterministic: the same bytes whenever and wherever.
std::filesystem::path written(const DataFolder& folder);

// The files of the stand-ins, and what is known of them.

/// Number of the stand-in trial of BROAD (its name begins with it).
inline constexpr const char* kStandInTrial = "00";
inline constexpr std::size_t kStandInTrialSamples = 25714;
/// A wand whose gyro clips about x at the tilted rail that TStick_Test05 of RepoIMU shows.
inline constexpr const char* kStandInWand = "TStick_StandIn.csv";
inline constexpr const char* kStandInFlight = "stand_in_flight.csv";
inline constexpr const char* kSphereLogFile = "orientation_all.csv";
inline constexpr std::size_t kStandInSphereSamples = 3751;
/// Between the first and the last place of the rolling sphere of the stand-in.
inline constexpr double kStandInSphereNet_m = 3.0;

/// Of norlab's sweeps: their number, half the room's sides, and the lidar's pose so long after the first one's start.
inline constexpr int kNorlabSweeps = 6;
inline constexpr std::array<double, 3> kNorlabRoom_m = {6.0, 4.0, 1.5};
Eigen::Isometry3d norlab_pose(double t_s);

/// The rail of the real wand: x = +-distance + offset + y_slope y + z_slope z.
struct WandRail {
  double distance_rad_s = 7.2987, offset_rad_s = -0.046, y_slope = 0.006, z_slope = -0.0181;
};
/// Samples of the stand-in wand at that rail, counted on the motion itself.
int stand_in_wand_clipped();

}  // namespace tumble::test
