// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// Each source has one writer, which writes its files into an existing folder and throws std::runtime_error when it
/// cannot.
namespace tumble::test {

/// Writes a BROAD trial: 90 s of a sensor in a hand, still at the start, in the middle and at the end; the markers are
/// sometimes hidden.
void write_broad(const std::filesystem::path& folder);
/// Writes a RepoIMU recording: two minutes of a wand that is twirled about x beyond its gyro's saturation level.
void write_repoimu(const std::filesystem::path& folder);
/// Writes norlab's example: six sweeps of a lidar that glides and turns in a room, VTK as text, with reference poses
/// and an odometry that errs by 5 mm.
void write_norlab(const std::filesystem::path& folder);
/// Writes the sphere's log: 30 s of pure rolling with a sphere of 29 cm, whose attitudes come from the published
/// filter's code of 2021.
void write_sphere_log(const std::filesystem::path& folder);

}  // namespace tumble::test
