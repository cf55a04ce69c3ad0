// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/merge_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "unit_alignment.hpp"

namespace tumble {

namespace {

using Kind = HealthFinding::Kind;

constexpr double kSilentReported_s = 0.5;  // minimum duration without readings that is reported
// Without an observed plane of saturated readings, a sensing element is assumed to be aligned with its axis. With a
// standard deviation of 0.03 for the cross-axis sensitivity, three clipped IMUs could not determine the rate.
constexpr double kUnknownSlope = 0.0;

struct Units {
  std::size_t count = 0;  ///< number of all IMUs
  std::vector<std::size_t> index;
  std::vector<Eigen::Isometry3d> T_BI;
  std::vector<std::vector<ImuSample>> samples;
  std::vector<SensingDirections> gyro_elements, accel_elements;
  std::vector<std::vector<FrozenAxis>> frozen;
};

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
    std::optional<std::size_t> first;  // index of the IMU with the earliest reading
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
  units.count = recordings.size();
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

/// TimeWithoutGaps removes gaps from time stamps, so that ImuMerge keeps its calibration.
class TimeWithoutGaps {
 public:
  explicit TimeWithoutGaps(double gap_max_s) : gap_max_s_(gap_max_s) {}

  std::pair<TimeNs, bool> next(TimeNs time_ns) {
    const bool after_gap = started_ && seconds(time_ns - last_ns_) > gap_max_s_;
    if (after_gap) {
      const TimeNs removed_ns = time_ns - last_ns_ - step_ns_;
      gaps_.push_back({time_ns - removed_ns - removed(), removed_ns + removed()});
    } else if (started_) {
      step_ns_ = time_ns - last_ns_;
    }
    started_ = true;
    last_ns_ = time_ns;
    return {time_ns - removed(), after_gap};
  }
  TimeNs in_recording(TimeNs time_ns) const {
    TimeNs removed_ns = 0;
    for (const Gap& gap : gaps_) {
      if (time_ns >= gap.end_ns) removed_ns = gap.removed_ns;
    }
    return time_ns + removed_ns;
  }

 private:
  struct Gap {
    TimeNs end_ns, removed_ns;  ///< end of a gap, in time without gaps; total duration of all gaps so far
  };
  TimeNs removed() const { return gaps_.empty() ? 0 : gaps_.back().removed_ns; }

  double gap_max_s_;
  std::vector<Gap> gaps_;
  bool started_ = false;
  TimeNs last_ns_ = 0, step_ns_ = 1;
};

/// The calibration of the IMUs remains valid after a gap.
void delete_motion(ImuMerge::State& state) {
  for (ImuMerge::Unit& unit : state.units) unit.window = {};
  state.recovery.running = false;
  state.window_s = 0.0;
  state.windows = 0;
}

Status run(const ImuMerge& merge, double gap_max_s, const Units& units, ImuMerge::State& state,
           std::vector<ImuSample>& out) {
  std::vector<ImuSample> now(units.samples.size());
  std::optional<ImuSample> merged;
  TimeWithoutGaps time(gap_max_s);
  out.clear();
  for (std::size_t k = 0; k < units.samples[0].size(); ++k) {
    for (std::size_t unit = 0; unit < now.size(); ++unit) now[unit] = units.samples[unit][k];
    const bool received = std::any_of(now.begin(), now.end(), [](const ImuSample& s) { return is_finite(s); });
    if (received) {
      const auto [time_ns, after_gap] = time.next(now[0].time_ns);
      now[0].time_ns = time_ns;
      if (after_gap) delete_motion(state);
    }
    if (Status status = merge.step(now, state, merged); !status.ok()) return status;
    if (Status status = ImuMerge::verdict(state); !status.ok()) return status;
    if (merged) out.push_back(*merged);
  }
  for (ImuSample& sample : out) sample.time_ns = time.in_recording(sample.time_ns);
  for (ImuMerge::Unit& unit : state.units) {
    unit.frozen_since_ns = time.in_recording(unit.frozen_since_ns);
    unit.disagrees_since_ns = time.in_recording(unit.disagrees_since_ns);
  }
  return {};
}

std::string name(const Units& units, std::size_t k) {
  return unit_name(units.index[k], units.count);
}

void exclude(std::vector<ImuSample>& unit, TimeNs from_ns, TimeNs to_ns = std::numeric_limits<TimeNs>::max()) {
  for (ImuSample& sample : unit) {
    if (sample.time_ns >= from_ns && sample.time_ns <= to_ns)
      sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

struct Interval {
  TimeNs from_ns = 0, to_ns = 0;
};

std::optional<Interval> silent_interval(const std::vector<ImuSample>& unit) {
  std::size_t from = unit.size();
  for (std::size_t k = 0; k <= unit.size(); ++k) {
    const bool missing_samples = k < unit.size() && !is_finite(unit[k]);
    if (missing_samples && from == unit.size()) from = k;
    if (missing_samples || from == unit.size()) continue;
    if (seconds(unit[k - 1].time_ns - unit[from].time_ns) >= kSilentReported_s)
      return Interval{unit[from].time_ns, unit[k - 1].time_ns};
    from = unit.size();
  }
  return std::nullopt;
}

void report_silent(const Units& units, SensorHealth& faults) {
  for (std::size_t k = 0; k < units.index.size(); ++k) {
    if (const auto silent = silent_interval(units.samples[k]))
      faults.add(Kind::unit_silent,
                 {ErrorCode::out_of_range, "time in s without readings", seconds(silent->to_ns - silent->from_ns),
                  kSilentReported_s},
                 name(units, k), "", silent->from_ns);
  }
}

/// Returns an error if all IMUs are frozen.
Status exclude_frozen(Units& units, SensorHealth& faults) {
  const std::size_t before = faults.findings.size();
  for (std::size_t unit = 0; unit < units.index.size(); ++unit) {
    for (const FrozenAxis& axis : units.frozen[unit]) {
      exclude(units.samples[unit], axis.from_ns, axis.to_ns);
      add_finding(Kind::unit_frozen, name(units, unit), axis, faults);
    }
  }
  if (faults.findings.size() == before) return {};
  for (std::size_t k = 0; k < units.samples[0].size(); ++k) {
    const bool any_reading = std::any_of(units.samples.begin(), units.samples.end(),
                                         [&](const std::vector<ImuSample>& unit) { return is_finite(unit[k]); });
    if (!any_reading) return faults.findings.back().status();
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

/// Returns whether ImuMerge found a faulty IMU.
bool exclude_found(const ImuMerge::State& state, Units& units, SensorHealth& faults) {
  bool any = false;
  for (std::size_t k = units.index.size(); k-- > 0;) {
    const ImuMerge::Unit& unit = state.units[k];
    if (unit.frozen) {
      any = true;
      exclude(units.samples[k], unit.frozen_since_ns);
      ImuMerge::add_finding(unit, name(units, k), faults);
    } else if (unit.disagrees) {
      any = true;
      ImuMerge::add_finding(unit, name(units, k), faults);
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

std::string unit_name(std::size_t unit, std::size_t units) {
  return units > 1 ? "imu_" + std::to_string(unit + 1) : "imu";
}

Status merge_recordings(std::span<const UnitRecording> recordings, ImuMerge::Params params, MergedRecordings& out) {
  out = {};
  Units units;
  if (Status status = prepare(recordings, units); !status.ok()) return status;
  report_silent(units, out.faults);
  if (Status status = exclude_frozen(units, out.faults); !status.ok()) return status;
  set_units(units, params);
  auto state = std::make_unique<ImuMerge::State>();
  const ImuMerge first(params);
  if (Status status = run(first, params.gap_max_s, units, *state, out.samples); !status.ok()) return status;
  const bool faulty = exclude_found(*state, units, out.faults);
  set_units(units, params);
  const ImuMerge merge(params);
  if (faulty) {
    *state = {};
    if (Status status = run(merge, params.gap_max_s, units, *state, out.samples); !status.ok()) return status;
  }
  report_calibration(merge, *state, units, out);
  return {};
}

}  // namespace tumble
