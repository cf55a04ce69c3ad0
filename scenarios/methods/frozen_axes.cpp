// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/frozen_axes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tumble::scenarios {

namespace {

constexpr double kLonger = 10.0;       // than any hold before
constexpr double kRailShare = 0.9;     // of the stated range, from which on a reading may stand at its rail
constexpr double kExtremeShare = 0.5;  // and from which on where it is the highest or lowest of the axis
constexpr double kQuanta = 50.0;       // of the axis, by which another moves: a part of 2 % in this axis is one quantum
constexpr double kTurning_rad_s = 0.3;  // by which another axis of a gyro changes, for the body to move
constexpr double kPushed_m_s2 = 1.0;    // and of an accelerometer
constexpr double kChanging = 0.5;       // of the samples of a hold, in which another axis changes

/// One axis of a triad, beside the two others.
class Axis {
 public:
  Axis(const sim::ImuRecord& record, std::span<const ImuSample> samples, Triad triad, int axis)
      : samples_(samples), triad_(triad), axis_(axis) {
    const bool gyro = triad == Triad::gyro;
    flag_ = static_cast<std::uint8_t>((gyro ? kClipGyroX : kClipAccelX) << axis);
    const double stated = gyro ? record.stated_gyro_range_rad_s : record.stated_accel_range_m_s2;
    if (stated > 0.0) rail_ = kRailShare * stated, extreme_ = kExtremeShare * stated;
    least_span_ = gyro ? kTurning_rad_s : kPushed_m_s2;
    double quantum = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      lowest_ = std::min(lowest_, reading(k)[axis_]);
      highest_ = std::max(highest_, reading(k)[axis_]);
      if (k > 0 && !repeats(k)) quantum = std::min(quantum, std::abs(reading(k)[axis_] - reading(k - 1)[axis_]));
    }
    least_span_ = std::max(least_span_, kQuanta * quantum);
  }

  void find(std::vector<FrozenAxis>& out) const {
    double moved_s = 0.0, longest_s = 0.0;
    for (std::size_t first = 0; first < samples_.size();) {
      std::size_t last = first;
      while (last + 1 < samples_.size() && repeats(last + 1)) ++last;
      const double held_s = seconds(samples_[last].time_ns - samples_[first].time_ns);
      const bool told = moved_s >= kAxisFrozen_s && held_s >= std::max(kAxisFrozen_s, kLonger * longest_s);
      if (told && !at_rail(first, last) && others_move(first, last)) {
        out.push_back({triad_, axis_, samples_[first].time_ns, samples_[last].time_ns});
      } else if (!at_rail(first, last)) {
        longest_s = std::max(longest_s, held_s);
      }
      if (last + 1 < samples_.size()) moved_s += seconds(samples_[last + 1].time_ns - samples_[last].time_ns);
      first = last + 1;
    }
  }

 private:
  const Eigen::Vector3d& reading(std::size_t k) const {
    return triad_ == Triad::gyro ? samples_[k].angular_velocity_rad_s : samples_[k].specific_force_m_s2;
  }

  bool repeats(std::size_t k) const { return reading(k)[axis_] == reading(k - 1)[axis_]; }

  bool at_rail(std::size_t first, std::size_t last) const {
    const double held = reading(first)[axis_];
    if (std::abs(held) >= rail_) return true;
    if (std::abs(held) >= extreme_ && (held == lowest_ || held == highest_)) return true;
    return std::any_of(samples_.begin() + static_cast<std::ptrdiff_t>(first),
                       samples_.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                       [&](const ImuSample& sample) { return (sample.device_clip_flags & flag_) != 0; });
  }

  bool others_move(std::size_t first, std::size_t last) const {
    for (int other = 0; other < 3; ++other) {
      if (other == axis_) continue;
      double low = reading(first)[other], high = low;
      std::size_t changes = 0;
      for (std::size_t k = first + 1; k <= last; ++k) {
        const double now = reading(k)[other];
        low = std::min(low, now), high = std::max(high, now);
        changes += now != reading(k - 1)[other] ? 1 : 0;
      }
      if (high - low >= least_span_ && static_cast<double>(changes) >= kChanging * static_cast<double>(last - first)) {
        return true;
      }
    }
    return false;
  }

  std::span<const ImuSample> samples_;
  Triad triad_;
  int axis_;
  std::uint8_t flag_ = 0;
  double rail_ = std::numeric_limits<double>::infinity(), extreme_ = 0.0;
  double lowest_ = rail_, highest_ = -rail_, least_span_ = 0.0;
};

}  // namespace

std::string to_string(const FrozenAxis& frozen) {
  return std::string(frozen.triad == Triad::gyro ? "gyro_" : "accel_") + "xyz"[frozen.axis];
}

std::vector<FrozenAxis> find_frozen_axes(const sim::ImuRecord& record, std::span<const ImuSample> samples) {
  std::vector<FrozenAxis> out;
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    for (int axis = 0; axis < 3; ++axis) Axis(record, samples, triad, axis).find(out);
  }
  return out;
}

}  // namespace tumble::scenarios
