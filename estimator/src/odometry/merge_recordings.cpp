// SPDX-License-Identifier: BSD-3-Clause
#include "imu_time_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

namespace tumble {

namespace {

ImuSample absent_sample(TimeNs time_ns) {
  ImuSample sample;
  sample.time_ns = time_ns;
  sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
  return sample;
}

TimeNs newest_ns(std::size_t unit, const ImuTimeAlignment::State& state) {
  const std::vector<ImuSample>& readings = state.readings[unit];
  return readings.empty() ? *state.first_ns : readings.back().time_ns;
}

TimeNs newest_ns(const ImuTimeAlignment::State& state) {
  TimeNs out = *state.first_ns;
  for (const std::vector<ImuSample>& readings : state.readings) {
    if (!readings.empty()) out = std::max(out, readings.back().time_ns);
  }
  return out;
}

bool is_silent(std::size_t unit, const ImuTimeAlignment::State& state) {
  return seconds(newest_ns(state) - newest_ns(unit, state)) > ImuTimeAlignment::kSilentMax_s;
}

auto samples_after_common_time(const std::vector<ImuSample>& readings, const ImuTimeAlignment::State& state) {
  return std::find_if(readings.begin(), readings.end(), [&](const ImuSample& reading) {
    return !state.newest_common_time_ns || reading.time_ns > *state.newest_common_time_ns;
  });
}

ImuSample reading_at(TimeNs time_ns, const std::vector<ImuSample>& readings) {
  const auto after = std::find_if(readings.begin(), readings.end(),
                                  [&](const ImuSample& reading) { return reading.time_ns >= time_ns; });
  if (after != readings.end() && after->time_ns == time_ns) return *after;
  if (after == readings.end() || after == readings.begin()) return absent_sample(time_ns);
  const std::span<const ImuSample> neighbours(&*(after - 1), 2);
  if (seconds(time_ns - neighbours[0].time_ns) > ImuTimeAlignment::kSilentMax_s ||
      seconds(neighbours[1].time_ns - time_ns) > ImuTimeAlignment::kSilentMax_s)
    return absent_sample(time_ns);
  ImuInterpolation unit(neighbours);
  return unit.at(time_ns, unit.samples_around(time_ns));
}

using Kind = HealthFinding::Kind;

constexpr double kSilentReported_s = 0.5;  // minimum duration without readings that is reported
// If the saturation plane (SaturationPlane) of a sensing element has not been observed, the sensing element is assumed
// aligned with its axis. If the cross-axis sensitivity were assumed uncertain (standard deviation 0.03), the angular
// rate would be undetermined while three IMUs clip.
constexpr double kUnknownSlope = 0.0;

struct ImuReadingSets {
  std::size_t count = 0;  ///< number of all IMUs
  std::vector<std::size_t> index;
  std::vector<Eigen::Isometry3d> T_BI;
  std::vector<std::vector<ImuSample>> samples;
  std::vector<SensingDirections> gyro_sensing_directions, accel_sensing_directions;
  std::vector<std::vector<FrozenAxis>> frozen_axes;
};

void flag_clipped(const ImuDataSheet& sheet, std::vector<ImuSample>& samples, SensingDirections& gyro,
                  SensingDirections& accel) {
  const ClippingFinder::ClippingSearchResult found = ClippingFinder(clipping_finder_params(sheet)).find(samples);
  const ConfirmedSaturation certain = confirmed_saturation(found.saturation_levels, sheet);
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k].device_clip_flags = certain.flags(samples[k], found.clipping_per_sample[k]);
  gyro = found.saturation_levels.rows(Triad::gyro, kUnknownSlope);
  accel = found.saturation_levels.rows(Triad::accelerometer, kUnknownSlope);
}

Status align(std::vector<std::vector<ImuSample>>& samples) {
  const ImuTimeAlignment alignment(samples.size());
  ImuTimeAlignment::State state;
  ImuTimeAlignment::Readings readings;
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

Status prepare_imu_readings(std::span<const ImuRecording> recordings, ImuReadingSets& units) {
  units.count = recordings.size();
  for (std::size_t k = 0; k < recordings.size() && units.index.size() < ImuMerge::kImus; ++k) {
    const ImuRecording& recording = recordings[k];
    if (recording.samples.empty()) continue;
    std::vector<ImuSample> samples = recording.samples;
    flag_clipped(recording.data_sheet, samples, units.gyro_sensing_directions.emplace_back(),
                 units.accel_sensing_directions.emplace_back());
    units.index.push_back(k);
    units.T_BI.push_back(recording.T_BI);
    units.frozen_axes.push_back(
        find_frozen_axes(FrozenAxes({.gyro_range_rad_s = recording.data_sheet.gyro_range_rad_s,
                                     .accel_range_m_s2 = recording.data_sheet.accel_range_m_s2}),
                         samples));
    units.samples.push_back(std::move(samples));
  }
  if (units.index.empty()) return {ErrorCode::empty, "number of IMUs with samples", 0.0, 1.0};
  return align(units.samples);
}

void set_imus(const ImuReadingSets& units, ImuMerge::Setup& setup) {
  setup.count = static_cast<int>(units.index.size());
  std::copy(units.T_BI.begin(), units.T_BI.end(), setup.T_mean_imu.begin());
  std::copy(units.gyro_sensing_directions.begin(), units.gyro_sensing_directions.end(),
            setup.gyro_sensing_directions.begin());
  std::copy(units.accel_sensing_directions.begin(), units.accel_sensing_directions.end(),
            setup.accel_sensing_directions.begin());
}

/// After a gap between IMU samples, only the motion state is reset, because the calibration of the IMUs remains valid.
void reset_motion_state(ImuMerge::State& state) {
  for (ImuMerge::Unit& unit : state.imus) unit.window = {};
  state.rate_recovery.running = false;
  state.window_s = 0.0;
  state.window_count = 0;
}

Status merge_imu_readings(const ImuMerge& merge, const ImuReadingSets& units, ImuMerge::State& state,
                          std::vector<ImuSample>& out) {
  std::vector<ImuSample> now(units.samples.size());
  std::optional<ImuSample> merged;
  TimeNs step_ns = 1;  // newest time between two samples without a gap
  out.clear();
  for (std::size_t k = 0; k < units.samples[0].size(); ++k) {
    for (std::size_t unit = 0; unit < now.size(); ++unit) now[unit] = units.samples[unit][k];
    const bool received = std::any_of(now.begin(), now.end(), [](const ImuSample& s) { return is_finite(s); });
    if (received && state.sample_count > 0) {
      const TimeNs since_ns = now[0].time_ns - state.last_time_ns;
      if (seconds(since_ns) > ImuMerge::Setup::kGapMax_s) {
        reset_motion_state(state);
        state.last_time_ns = now[0].time_ns - step_ns;
      } else {
        step_ns = since_ns;
      }
    }
    if (Status status = merge.step(now, state, merged); !status.ok()) return status;
    if (Status status = ImuMerge::verdict(state); !status.ok()) return status;
    if (merged) out.push_back(*merged);
  }
  return {};
}

std::string name(const ImuReadingSets& units, std::size_t k) {
  return imu_name(units.index[k], units.count);
}

void exclude_samples(std::vector<ImuSample>& unit, TimeNs from_ns, TimeNs to_ns = std::numeric_limits<TimeNs>::max()) {
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

void report_silent_imus(const ImuReadingSets& units, SensorHealth& faults) {
  for (std::size_t k = 0; k < units.index.size(); ++k) {
    if (const auto silent = silent_interval(units.samples[k]))
      faults.add(Kind::imu_silent,
                 {ErrorCode::out_of_range, "time in s without readings", seconds(silent->to_ns - silent->from_ns),
                  kSilentReported_s},
                 name(units, k), "", silent->from_ns);
  }
}

Status exclude_frozen(ImuReadingSets& units, SensorHealth& faults) {
  const std::size_t before = faults.findings.size();
  for (std::size_t unit = 0; unit < units.index.size(); ++unit) {
    for (const FrozenAxis& axis : units.frozen_axes[unit]) {
      exclude_samples(units.samples[unit], axis.from_ns, axis.to_ns);
      add_finding(Kind::imu_frozen, name(units, unit), axis, faults);
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

void erase_imu(ImuReadingSets& units, std::size_t unit) {
  const auto at = static_cast<std::ptrdiff_t>(unit);
  units.index.erase(units.index.begin() + at);
  units.T_BI.erase(units.T_BI.begin() + at);
  units.samples.erase(units.samples.begin() + at);
  units.gyro_sensing_directions.erase(units.gyro_sensing_directions.begin() + at);
  units.accel_sensing_directions.erase(units.accel_sensing_directions.begin() + at);
}

/// Returns whether ImuMerge found a faulty IMU.
bool exclude_faulty_imus(const ImuMerge::State& state, ImuReadingSets& units, SensorHealth& faults) {
  bool any = false;
  for (std::size_t k = units.index.size(); k-- > 0;) {
    const ImuMerge::Unit& unit = state.imus[k];
    if (unit.is_frozen) {
      any = true;
      exclude_samples(units.samples[k], unit.frozen_since_ns);
      ImuMerge::add_finding(unit, name(units, k), faults);
    } else if (unit.disagrees) {
      any = true;
      ImuMerge::add_finding(unit, name(units, k), faults);
      erase_imu(units, k);
    }
  }
  return any;
}

void report_calibration(const ImuMerge& merge, const ImuMerge::State& state, const ImuReadingSets& units,
                        MergedRecordings& out) {
  out.lever_arm_m = merge.mean_imu_position_m();
  out.lever_arm_agreement = ImuMerge::lever_arm_agreement(state);
  out.mislabelled_axes = state.imu_sign_check.detected_mirroring();
  for (std::size_t k = 0; k < units.index.size(); ++k) {
    const ImuMerge::Unit& unit = state.imus[k];
    constexpr int kOffset = ImuMerge::kErrorCount - 1;
    out.excluded_readings += static_cast<std::size_t>(unit.excluded_window_count);
    out.imus.push_back({units.index[k], unit.offset_s(), std::sqrt(std::max(0.0, unit.covariance(kOffset, kOffset))),
                        unit.x.head<3>().norm()});
  }
}

}  // namespace

Status StampOrder::order_of_stamp(TimeNs stamp_ns, State& state, Verdict& verdict) const {
  verdict = Verdict::continues_in_order;
  if (const Status status = check_stamp(stamp_ns, "time_ns"); !status.ok()) return status;
  if (!state.newest_ns) return {};
  const Status status = check_stamp_order(stamp_ns, *state.newest_ns, gap_max_s_);
  if (status.ok()) {
    state.rejected.reset();
    return {};
  }
  const bool gap = status.error_code == ErrorCode::gap;
  if (!state.rejected || !check_stamp_order(stamp_ns, state.rejected->last_ns, gap_max_s_).ok()) {
    state.rejected = RejectedStamps{stamp_ns, stamp_ns};
    return status;
  }
  state.rejected->last_ns = stamp_ns;
  const bool confirmed =
      check_stamp_order(stamp_ns, state.rejected->first_ns, kStepBack_s).error_code == ErrorCode::gap;
  if (!gap && !state.only_one_sample && !confirmed) return status;
  verdict = gap ? Verdict::restarts_after_gap : Verdict::restarts_after_step_back;
  return {};
}

void StampOrder::accept(TimeNs stamp_ns, State& state) {
  state = {.newest_ns = stamp_ns, .only_one_sample = !state.newest_ns, .rejected = std::nullopt};
}

Status ImuTimeAlignment::push(std::size_t unit, const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return {};
  std::vector<ImuSample>& readings = state.readings[unit];
  if (!readings.empty() && sample.time_ns <= readings.back().time_ns)
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(readings.back().time_ns)};
  state.first_ns = state.first_ns ? std::min(*state.first_ns, sample.time_ns) : sample.time_ns;
  readings.push_back(sample);
  return {};
}

bool ImuTimeAlignment::next(State& state, Readings& out, bool ended) const {
  if (!state.first_ns) return false;
  choose_reference(state);
  const auto at = samples_after_common_time(state.readings[state.reference_imu], state);
  if (at == state.readings[state.reference_imu].end()) return false;
  const TimeNs time_ns = at->time_ns;
  for (std::size_t unit = 0; unit < imu_count_; ++unit) {
    if (!ended && !is_complete(unit, time_ns, state)) return false;
  }
  state.newest_common_time_ns = time_ns;
  for (std::size_t unit = 0; unit < imu_count_; ++unit) {
    std::vector<ImuSample>& readings = state.readings[unit];
    out[unit] = reading_at(time_ns, readings);
    const auto later = samples_after_common_time(readings, state);
    if (later > readings.begin() + 1) readings.erase(readings.begin(), later - 1);
  }
  return true;
}

void ImuTimeAlignment::choose_reference(State& state) const {
  const std::vector<ImuSample>& readings = state.readings[state.reference_imu];
  if (samples_after_common_time(readings, state) != readings.end() || !is_silent(state.reference_imu, state)) return;
  for (std::size_t unit = 0; unit < imu_count_; ++unit) {
    if (is_silent(unit, state)) continue;
    state.reference_imu = unit;
    return;
  }
}

bool ImuTimeAlignment::is_complete(std::size_t unit, TimeNs time_ns, const State& state) const {
  const std::vector<ImuSample>& readings = state.readings[unit];
  return (!readings.empty() && readings.back().time_ns >= time_ns) || is_silent(unit, state);
}

ClippingFinder::Params clipping_finder_params(const ImuDataSheet& sheet) {
  ClippingFinder::Params out;
  if (sheet.gyro_range_rad_s > 0.0) out.axis_limit_params.stated_gyro_range_rad_s = sheet.gyro_range_rad_s;
  if (sheet.accel_range_m_s2 > 0.0) out.axis_limit_params.stated_accel_range_m_s2 = sheet.accel_range_m_s2;
  return out;
}

ConfirmedSaturation confirmed_saturation(const SaturationLevels& detected, const ImuDataSheet& sheet) {
  return {.gyro = detected.saturation_planes_in_use(),
          .accel = detected.saturation_planes_in_use(Triad::accelerometer),
          .gyro_range_rad_s = sheet.gyro_range_rad_s,
          .accel_range_m_s2 = sheet.accel_range_m_s2};
}

std::string imu_name(std::size_t unit, std::size_t units) {
  return units > 1 ? "imu_" + std::to_string(unit + 1) : "imu";
}

Status merge_recordings(std::span<const ImuRecording> recordings, ImuMerge::Setup setup, MergedRecordings& out) {
  out = {};
  ImuReadingSets units;
  if (Status status = prepare_imu_readings(recordings, units); !status.ok()) return status;
  report_silent_imus(units, out.faults);
  if (Status status = exclude_frozen(units, out.faults); !status.ok()) return status;
  set_imus(units, setup);
  auto state = std::make_unique<ImuMerge::State>();
  const ImuMerge first(setup);
  if (Status status = merge_imu_readings(first, units, *state, out.samples); !status.ok()) return status;
  const bool faulty = exclude_faulty_imus(*state, units, out.faults);
  set_imus(units, setup);
  const ImuMerge merge(setup);
  if (faulty) {
    *state = {};
    if (Status status = merge_imu_readings(merge, units, *state, out.samples); !status.ok()) return status;
  }
  report_calibration(merge, *state, units, out);
  return {};
}

}  // namespace tumble
