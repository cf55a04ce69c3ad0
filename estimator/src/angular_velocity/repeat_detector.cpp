// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/repeat_detector.hpp"

#include <algorithm>
#include <cmath>

#include "sample_hold.hpp"

namespace tumble {

namespace {

using sample_hold::kMoving_rad_s, sample_hold::kRepeatsMin, sample_hold::kSlowest;

constexpr double kMovingLeast = static_cast<double>(sample_hold::kMovingMin);
constexpr double kMemory = static_cast<double>(sample_hold::kMovingMax);

RepeatedReading repeated_reading(const RepeatDetector::RepetitionMemory& memory, const Eigen::Vector3d& reading) {
  RepeatedReading out;
  if (memory.moving < kMovingLeast || memory.repeated < kRepeatsMin * memory.moving) return out;
  out.reading_period_samples = memory.moving / std::max(1.0, memory.moving - memory.repeated);
  if (out.reading_period_samples > kSlowest) return {};
  out.repeats_reading = memory.equal_samples > 1.0 && memory.equal_samples <= kSlowest;
  out.age_samples = std::min(memory.equal_samples, kSlowest) - 0.5;
  out.reading_change = out.repeats_reading ? memory.now.reading_change : reading - memory.reading;
  return out;
}

}  // namespace

Eigen::Vector3d RepeatedReading::change_since_new_reading() const {
  return delay_samples() / reading_period_samples * reading_change;
}

void RepeatDetector::observe_reading(const ImuSample& sample, bool clipped, State& state) const {
  const bool moves = !clipped && sample.angular_velocity_rad_s.norm() >= kMoving_rad_s;
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    RepetitionMemory& memory = state.repetition[static_cast<std::size_t>(triad)];
    const Eigen::Vector3d& reading = triad_reading_of(sample, triad);
    const bool again = memory.equal_samples > 0.0 && reading == memory.reading;
    if (moves) {
      const double kept = 1.0 - 1.0 / kMemory;
      memory.moving = kept * memory.moving + 1.0;
      memory.repeated = kept * memory.repeated + (again ? 1.0 : 0.0);
    }
    memory.equal_samples = again ? memory.equal_samples + 1.0 : 1.0;
    memory.now = repeated_reading(memory, reading);
    memory.reading = reading;
  }
}

}  // namespace tumble
