// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// One writer per source; each writes its files into an existing folder and throws std::runtime_error when it cannot.
namespace tumble::test {

/// BROAD: 90 s of a sensor in a hand, still at the start, in the middle and at the end; markers hidden now and then.
void write_broad(const std::filesystem::path& folder);
/// RepoIMU: two minutes of a wand that is twirled beyond the rail of its gyro about x.
void write_repoimu(const std::filesystem::path& folder);
/// AirbrakesV2: a rocket that spins up to 38.9 rad/s; ten rows repeat a stamp, seven come long before the flight.
void write_airbrakes(const std::filesystem::path& folder);
/// norlab's example: six sweeps of a lidar that glides and turns in a room, VTK as text, with reference poses and an
/// odometry that errs by 5 mm.
void write_norlab(const std::filesystem::path& folder);
/// The sphere's log: 30 s of pure rolling of 29 cm, its attitudes written by the published filter's code of 2021.
void write_sphere_log(const std::filesystem::path& folder);

}  // namespace tumble::test
