// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// One writer per source. Each writes its files to an existing folder, and throws std::runtime_error if it cannot.
namespace tumble::test {

/// BROAD: 90 s of a hand-held sensor, stationary at the start, in the middle and at the end; markers are sometimes
/// hidden.
void write_broad(const std::filesystem::path& folder);
/// RepoIMU: two minutes of a wand that twirls beyond the saturation limit of its gyro about x.
void write_repoimu(const std::filesystem::path& folder);
/// AirbrakesV2: a rocket that spins at up to 38.9 rad/s; ten rows repeat a time stamp, seven are long before the
/// flight.
void write_airbrakes(const std::filesystem::path& folder);
/// norlab's example: six sweeps of a lidar that moves and rotates in a room, VTK as text, with reference poses and an
/// odometry with an error of 5 mm.
void write_norlab(const std::filesystem::path& folder);
/// The sphere's log: 30 s of pure rolling of a 29 cm sphere, with attitudes by the published filter's code of 2021.
void write_sphere_log(const std::filesystem::path& folder);

}  // namespace tumble::test
