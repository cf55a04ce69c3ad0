// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

/// What an estimate says against itself, or against what it was made of.
namespace tumble::scenarios {

struct Estimate;

/// One thing that an estimate doubts, for stages and programs; for people it is a row of the health as well.
struct Doubt {
  enum class About {
    readings,        ///< the IMU's contradict each other or gravity
    rates,           ///< as a whole (Estimate::doubted_rad2_s2), by `readings`
    flights,         ///< forces there are not what the turning makes; value: for how long [s]
    stamps,          ///< rounded more coarsely than the IMU beats; value: to what [s]
    rate_unit,       ///< perhaps no rad/s
    force_unit,      ///< perhaps no m/s^2
    attitude,        ///< its inclination is not known; value: for how long [s]
    place,           ///< where the run is on its map is not known; value: 0
    lidar_scale,     ///< ranges of another scale than the motion
    beyond_range,    ///< readings that the device cannot have measured; value: how many
    digest,          ///< the recording states none
    learnt_rig,      ///< what was learnt before is not of this rig; value: how far off [deviations]
    unit_frozen,     ///< `unit` repeats one reading; value: since when from the start [s], as of the next two
    unit_disagrees,  ///< `unit` is off from the others
    unit_silent,     ///< `unit` has no readings
  };
  About about = About::readings;
  double value = 1.0;
  std::string unit = {};  ///< "imu_2", or an axis of it, "imu_2_gyro_z"

  bool operator==(const Doubt&) const = default;
};

inline constexpr std::array kAllDoubts = {
    Doubt::About::readings,    Doubt::About::rates,          Doubt::About::flights,    Doubt::About::stamps,
    Doubt::About::rate_unit,   Doubt::About::force_unit,     Doubt::About::attitude,   Doubt::About::place,
    Doubt::About::lidar_scale, Doubt::About::beyond_range,   Doubt::About::digest,     Doubt::About::learnt_rig,
    Doubt::About::unit_frozen, Doubt::About::unit_disagrees, Doubt::About::unit_silent};

/// Its row of the health: `imu_implausible`, `imu_2_frozen_since_s`. The only place that knows these names.
std::string row_of(const Doubt& doubt);

/// Puts a doubt among those of an estimate, which stay in the order of their rows, and its row into the health. Takes
/// the place of one with the same row.
void add_doubt(const Doubt& doubt, Estimate& estimate);

/// Whether there is one about the same.
bool has_doubt(const Doubt& doubt, const Estimate& estimate);

/// Says in the health that something was looked at and is not doubted.
void tell_undoubted(Doubt::About about, Estimate& estimate);

/// The doubts of an estimate of which only the health was kept, as in its file.
std::vector<Doubt> doubts_in(const std::map<std::string, double>& health);

}  // namespace tumble::scenarios
