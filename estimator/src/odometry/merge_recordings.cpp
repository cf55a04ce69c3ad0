// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/merge_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/odometry/detail/unit_alignment.hpp"

namespace tumble {

namespace {

constexpr double kSilentReported_s = 0.5;  // minimum duration of a reported interval without readings
// A sensing element without an observed saturation plane is assumed to be exactly aligned with its axis. With an
// uncertainty of 0.03 of the cross-axis sensitivity, three clipped IMUs would no longer determine the rate.
constexpr double kUnknownSlope = 0.0;

/// The IMUs that provide samples, resampled to common times.
struct Units {
  std::vector<std::size_t> index;
  std::vector<Eigen::Isometry3d> T_BI;
  std::vector<std::vector<ImuSample>> samples;
  std::vector<SensingDirections> gyro_elements, accel_elements;
  std::vector<std::vector<FrozenAxis>> frozen;
};

/// Sets the clip flags in the readings of an IMU, and estimates the directions of its sensing elements. The IMU may
/// have frozen axes.
void flag_clipped(const ImuSheet& sheet, std::vector<ImuSample>& samples, SensingDirections& gyro,
                  SensingDirections& accel) {
  ClippingFinder::Params params;
  if (sheet.gyro_range_rad_s > 0.0) params.axis_aligned_rails.stated_gyro_rad_s = sheet.gyro_range_rad_s;
  if (sheet.accel_range_m_s2 > 0.0) params.axis_aligned_rails.stated_accel_m_s2 = sheet.accel_range_m_s2;
  const ClippingFinder::Found found = ClippingFinder(params).find(samples);
  const ConfirmedSaturation certain{.gyro = found.rails.planes_in_use(),
                                    .accel = found.rails.planes_in_use(Triad::accelerometer),
                                    .gyro_range_rad_s = sheet.gyro_range_rad_s,
                                    .accel_range_m_s2 = sheet.accel_range_m_s2};
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k].device_clip_flags = certain.flags(samples[k], found.clippings[k]);
  gyro = found.rails.rows(Triad::gyro, kUnknownSlope);
  accel = found.rails.rows(Triad::accelerometer, kUnknownSlope);
}

/// Resamples the readings of all IMUs to common times, in place.
Status align(std::vector<std::vector<ImuSample>>& samples) {
  const UnitAlignment alignment(samples.size());
  UnitAlignment::State state;
  UnitAlignment::Readings readings;
  std::vector<std::vector<ImuSample>> out(samples.size());
  std::vector<std::size_t> next(samples.size(), 0);
  const auto take = [&](bool ended) {
    while (alignment.next(state, readings, ended)) {
      for (std::size_t k = 0; k < out.size(); ++k) out[k].push_back(readings[k]);
    }
  };
  while (true) {
    std::optional<std::size_t> first;  // the IMU with the earliest reading
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (next[k] == samples[k].size()) continue;
      if (!first || samples[k][next[k]].time_ns < samples[*first][next[*first]].time_ns) first = k;
    }
    if (!first) break;
    if (Status status = alignment.push(*first, samples[*first][next[*first]++], state); !status.ok()) return status;
    take(false);
  }
  take(true);
  samples = std::move(out);
  return {};
}

Status prepare(std::span<const UnitRecording> recordings, Units& units) {
  for (std::size_t k = 0; k < recordings.size() && units.index.size() < ImuMerge::kImus; ++k) {
    const UnitRecording& recording = recordings[k];
    if (recording.samples.empty()) continue;
    std::vector<ImuSample> samples = recording.samples;
    flag_clipped(recording.sheet, samples, units.gyro_elements.emplace_back(), units.accel_elements.emplace_back());
    units.index.push_back(k);
    units.T_BI.push_back(recording.T_BI);
    units.frozen.push_back(find_frozen_axes(FrozenAxes({.gyro_range_rad_s = recording.sheet.gyro_range_rad_s,
                                                        .accel_range_m_s2 = recording.sheet.accel_range_m_s2}),
                                            samples));
    units.samples.push_back(std::move(samples));
  }
  if (units.index.empty()) return {ErrorCode::empty, "number of IMUs with samples", 0.0, 1.0};
  return align(units.samples);
}

void set_units(const Units& units, ImuMerge::Params& params) {
  params.count = static_cast<int>(units.index.size());
  std::copy(units.T_BI.begin(), units.T_BI.end(), params.T_CI.begin());
  std::copy(units.gyro_elements.begin(), units.gyro_elements.end(), params.gyro_elements.begin());
  std::copy(units.accel_elements.begin(), units.accel_elements.end(), params.accel_elements.begin());
}

Status run(const ImuMerge& merge, const Units& units, ImuMerge::State& state, std::vector<ImuSample>& out) {
  std::vector<ImuSample> now(units.samples.size());
  std::optional<ImuSample> merged;
  out.clear();
  for (std::size_t k = 0; k < units.samples[0].size(); ++k) {
    for (std::size_t unit = 0; unit < now.size(); ++unit) now[unit] = units.samples[unit][k];
    if (Status status = merge.step(now, state, merged); !status.ok()) return status;
    if (Status status = merge.verdict(state); !status.ok()) return status;
    if (merged) out.push_back(*merged);
  }
  return {};
}

/// Marks the readings of an IMU between `from_ns` and `to_ns` as absent.
void exclude(std::vector<ImuSample>& unit, TimeNs from_ns, TimeNs to_ns = std::numeric_limits<TimeNs>::max()) {
  for (ImuSample& sample : unit) {
    if (sample.time_ns >= from_ns && sample.time_ns <= to_ns)
      sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

/// Returns the start of the first interval without readings, if the interval is long or lasts until the end of the
/// recording.
std::optional<TimeNs> silent_since(const std::vector<ImuSample>& unit) {
  std::size_t from = unit.size();
  for (std::size_t k = 0; k <= unit.size(); ++k) {
    const bool missing_samples = k < unit.size() && !is_finite(unit[k]);
    if (missing_samples && from == unit.size()) from = k;
    if (missing_samples || from == unit.size()) continue;
    if (seconds(unit[k - 1].time_ns - unit[from].time_ns) >= kSilentReported_s) return unit[from].time_ns;
    from = unit.size();
  }
  return std::nullopt;
}

void report_silent(const Units& units, std::vector<UnitFault>& faults) {
  for (std::size_t k = 0; k < units.index.size(); ++k) {
    const std::optional<TimeNs> since_ns = silent_since(units.samples[k]);
    if (since_ns) faults.push_back({UnitFault::Kind::silent, units.index[k], *since_ns, {}});
  }
}

Status frozen_in_all(const FrozenAxis& axis) {
  constexpr const char* kFields[2][3] = {{"time in s for which gyro x repeats one reading (no other healthy IMU)",
                                          "time in s for which gyro y repeats one reading (no other healthy IMU)",
                                          "time in s for which gyro z repeats one reading (no other healthy IMU)"},
                                         {"time in s for which accel x repeats one reading (no other healthy IMU)",
                                          "time in s for which accel y repeats one reading (no other healthy IMU)",
                                          "time in s for which accel z repeats one reading (no other healthy IMU)"}};
  const char* field = kFields[axis.triad == Triad::gyro ? 0 : 1][axis.axis];
  return {ErrorCode::out_of_range, field, seconds(axis.to_ns - axis.from_ns), FrozenAxes::Params{}.frozen_s};
}

/// Excludes the readings of an IMU while one of its axes is frozen. If no IMU remains, returns an error.
Status exclude_frozen(Units& units, std::vector<UnitFault>& faults) {
  std::optional<FrozenAxis> any;
  for (std::size_t unit = 0; unit < units.index.size(); ++unit) {
    for (const FrozenAxis& axis : units.frozen[unit]) {
      exclude(units.samples[unit], axis.from_ns, axis.to_ns);
      faults.push_back({UnitFault::Kind::frozen_axis, units.index[unit], axis.from_ns, axis});
      any = axis;
    }
  }
  if (!any) return {};
  for (std::size_t k = 0; k < units.samples[0].size(); ++k) {
    const bool any_reading = std::any_of(units.samples.begin(), units.samples.end(),
                                         [&](const std::vector<ImuSample>& unit) { return is_finite(unit[k]); });
    if (!any_reading) return frozen_in_all(*any);
  }
  return {};
}

void erase_unit(Units& units, std::size_t unit) {
  const auto at = static_cast<std::ptrdiff_t>(unit);
  units.index.erase(units.index.begin() + at);
  units.T_BI.erase(units.T_BI.begin() + at);
  units.samples.erase(units.samples.begin() + at);
  units.gyro_elements.erase(units.gyro_elements.begin() + at);
  units.accel_elements.erase(units.accel_elements.begin() + at);
}

/// Excludes the IMUs that ImuMerge classified as faulty. Returns whether there are faulty IMUs.
bool exclude_found(const ImuMerge::State& state, Units& units, std::vector<UnitFault>& faults) {
  bool any = false;
  for (std::size_t k = units.index.size(); k-- > 0;) {
    const ImuMerge::Unit& unit = state.units[k];
    if (unit.frozen) {
      any = true;
      exclude(units.samples[k], unit.frozen_since_ns);
      faults.push_back({UnitFault::Kind::frozen, units.index[k], unit.frozen_since_ns, {}});
    } else if (unit.disagrees) {
      any = true;
      faults.push_back({UnitFault::Kind::disagrees, units.index[k], unit.disagrees_since_ns, {}});
      erase_unit(units, k);
    }
  }
  return any;
}

void report_calibration(const ImuMerge& merge, const ImuMerge::State& state, const Units& units,
                        MergedRecordings& out) {
  out.lever_arm_m = merge.p_C_m();
  out.lever_arm_agreement = ImuMerge::lever_arm_agreement(state);
  out.mislabelled_axes = state.sign_check.detected();
  for (std::size_t k = 0; k < units.index.size(); ++k) {
    const ImuMerge::Unit& unit = state.units[k];
    constexpr int kOffset = ImuMerge::kErrorCount - 1;
    out.excluded_readings += static_cast<std::size_t>(unit.excluded_windows);
    out.units.push_back(
        {units.index[k], unit.offset_s(), std::sqrt(std::max(0.0, unit.P(kOffset, kOffset))), unit.x.head<3>().norm()});
  }
}

}  // namespace

Status merge_recordings(std::span<const UnitRecording> recordings, ImuMerge::Params params, MergedRecordings& out) {
  out = {};
  Units units;
  if (Status status = prepare(recordings, units); !status.ok()) return status;
  report_silent(units, out.faults);
  if (Status status = exclude_frozen(units, out.faults); !status.ok()) return status;
  set_units(units, params);
  auto state = std::make_unique<ImuMerge::State>();
  if (Status status = run(ImuMerge(params), units, *state, out.samples); !status.ok()) return status;
  const bool faulty = exclude_found(*state, units, out.faults);
  set_units(units, params);
  const ImuMerge merge(params);
  if (faulty) {
    *state = {};
    if (Status status = run(merge, units, *state, out.samples); !status.ok()) return status;
  }
  report_calibration(merge, *state, units, out);
  return {};
}

}  // namespace tumble
