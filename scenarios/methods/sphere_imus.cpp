// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sphere_imus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/frozen_axes.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/attitude/imu_merge.hpp"
#include "tumble/common/detail/imu_interpolation.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kSilentMaxS = 0.05;      // a unit without readings for longer is absent
constexpr double kEdgeShare = 0.9;        // fraction of a sample period over which end readings are extrapolated
constexpr double kSilentReportedS = 0.5;  // a longer silence is reported
// Sensing elements without an observed saturation plane are assumed aligned and exact. With an uncertainty of 0.03 for
// the cross-axis sensitivity, three clipped units would no longer determine the rate (slip_long, seeds 4, 30 and 42).
constexpr double kUnknownSlope = 0.0;

ImuSample absent(TimeNs time_ns) {
  ImuSample sample;
  sample.time_ns = time_ns;
  sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
  return sample;
}

/// Returns the usable readings of an IMU: finite, in order and within the device's range. Throws BadInput if the
/// record's arrays differ in length.
std::vector<ImuSample> readings_of(const sim::ImuRecord& record, Status& status, int& beyond_range) {
  std::vector<ImuSample> samples;
  status = bridge::imu_samples(record, samples);
  if (status.ok()) {
    beyond_range += static_cast<int>(record.time_ns.size() - samples.size());
    return samples;
  }
  for (std::size_t k = 0; k < record.time_ns.size(); ++k) {
    const TimeNs time_ns = record.time_ns[k];
    if (!record.gyro_rad_s[k].allFinite() || !record.accel_m_s2[k].allFinite()) continue;
    if (!bridge::check_range(record, record.gyro_rad_s[k], record.accel_m_s2[k]).ok()) {
      ++beyond_range;
      continue;
    }
    if (!samples.empty() && time_ns <= samples.back().time_ns) continue;
    samples.push_back({time_ns, record.gyro_rad_s[k], record.accel_m_s2[k], 0});
  }
  return samples;
}

/// Sets the clip flags of an IMU's readings and estimates the directions of its sensing elements. The IMU may have
/// frozen axes.
void judge(const sim::ImuRecord& record, std::vector<ImuSample>& samples, ElementRows& gyro, ElementRows& accel) {
  ClippingFinder::Params params;
  params.upright_rails = stated_rails(record);
  const ClippingFinder::Found found = ClippingFinder(params).find(samples);
  const CertainRails certain{.gyro = found.rails.planes_in_use(),
                             .accel = found.rails.planes_in_use(Triad::accelerometer),
                             .gyro_range_rad_s = record.stated_gyro_range_rad_s,
                             .accel_range_m_s2 = record.stated_accel_range_m_s2};
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k].device_clip_flags = certain.flags(samples[k], found.clippings[k]);
  gyro = found.rails.rows(Triad::gyro, kUnknownSlope);
  accel = found.rails.rows(Triad::accelerometer, kUnknownSlope);
}

/// Resamples the readings of an IMU to the times of another IMU. A reading is absent if the nearest reading is further
/// away than kSilentMaxS, and beyond a sample period outside the readings.
std::vector<ImuSample> at_times_of(const std::vector<ImuSample>& primary, const std::vector<ImuSample>& own) {
  std::vector<ImuSample> out;
  out.reserve(primary.size());
  if (own.size() < 2) {
    for (const ImuSample& sample : primary)
      out.push_back(own.front().time_ns == sample.time_ns ? own.front() : absent(sample.time_ns));
    return out;
  }
  const double edge_s = kEdgeShare * seconds(own.back().time_ns - own[own.size() - 2].time_ns);
  ImuInterpolation unit(own);
  for (const ImuSample& sample : primary) {
    const ImuNeighbours near = unit.around(sample.time_ns);
    const double before_s = seconds(sample.time_ns - own[near.before].time_ns);
    const double after_s = seconds(own[near.after].time_ns - sample.time_ns);
    const bool read_here = before_s == 0.0 || after_s == 0.0;
    const bool available = read_here || (std::max(std::abs(before_s), std::abs(after_s)) <= kSilentMaxS &&
                                         (near.between() || std::min(std::abs(before_s), std::abs(after_s)) < edge_s));
    out.push_back(available ? unit.at(sample.time_ns, near) : absent(sample.time_ns));
  }
  return out;
}

/// All IMUs resampled to common times.
struct Units {
  std::vector<std::string> names;
  std::vector<Eigen::Isometry3d> T_BI;
  std::vector<std::vector<ImuSample>> samples;
  std::vector<ElementRows> gyro_elements, accel_elements;
  std::vector<std::vector<FrozenAxis>> frozen;
  int resampled = 0, beyond_range = 0;
};

/// Returns the longest time between `first_ns` and `last_ns` without a reading of the IMU.
TimeNs longest_silence(const std::vector<ImuSample>& unit, TimeNs first_ns, TimeNs last_ns) {
  TimeNs longest_ns = std::max(unit.front().time_ns - first_ns, last_ns - unit.back().time_ns);
  for (std::size_t k = 1; k < unit.size(); ++k) {
    longest_ns = std::max(longest_ns, unit[k].time_ns - unit[k - 1].time_ns);
  }
  return longest_ns;
}

/// Chooses the valid IMU that supplies the times: the first valid IMU, or a later IMU without gaps.
std::optional<std::size_t> choose_base(const std::vector<std::vector<ImuSample>>& readings,
                                       const std::vector<Status>& statuses) {
  TimeNs first_ns = std::numeric_limits<TimeNs>::max(), last_ns = std::numeric_limits<TimeNs>::min();
  for (const std::vector<ImuSample>& unit : readings) {
    first_ns = std::min(first_ns, unit.front().time_ns);
    last_ns = std::max(last_ns, unit.back().time_ns);
  }
  std::optional<std::size_t> base;
  double least_s = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (!statuses[k].ok()) continue;
    const double silent_s = seconds(longest_silence(readings[k], first_ns, last_ns));
    if (base && silent_s + kSilentMaxS >= least_s) continue;
    base = k;
    least_s = silent_s;
  }
  return base;
}

Status units_of(const sim::Sensors& sensors, Units& units) {
  if (sensors.imus.empty()) return {Trouble::empty, "imus", 0.0, 1.0};
  std::vector<const sim::ImuRecord*> records;
  std::vector<std::vector<ImuSample>> readings;
  std::vector<Status> statuses;
  Status primary_status;
  for (const sim::ImuRecord& record : sensors.imus) {
    if (&record != &sensors.imus.front() && record.name == "imu_reference") continue;
    if (records.size() == ImuMerge::kImus) break;
    Status status;
    std::vector<ImuSample> samples = readings_of(record, status, units.beyond_range);
    if (&record == &sensors.imus.front()) primary_status = status;
    if (samples.empty()) continue;
    judge(record, samples, units.gyro_elements.emplace_back(), units.accel_elements.emplace_back());
    records.push_back(&record);
    readings.push_back(std::move(samples));
    statuses.push_back(status);
  }
  const std::optional<std::size_t> base = choose_base(readings, statuses);
  if (!base) return primary_status;
  const std::vector<ImuSample> times = readings[*base];
  for (std::size_t k = 0; k < records.size(); ++k) {
    std::vector<ImuSample> samples = std::move(readings[k]);
    const bool same = records[k]->time_ns == records[*base]->time_ns && samples.size() == records[k]->time_ns.size();
    units.names.push_back(records[k]->name);
    units.T_BI.push_back(records[k]->T_BI);
    units.frozen.push_back(find_frozen_axes(*records[k], samples));
    if (!same) {
      samples = at_times_of(times, samples);
      ++units.resampled;
    }
    units.samples.push_back(std::move(samples));
  }
  return {};
}

void give_units(const Units& units, ImuMerge::Params& params) {
  params.count = static_cast<int>(units.names.size());
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

/// Marks the readings of `unit` from `from_ns` on as absent.
void silence(std::vector<ImuSample>& unit, TimeNs from_ns, TimeNs to_ns = std::numeric_limits<TimeNs>::max()) {
  for (ImuSample& sample : unit) {
    if (sample.time_ns >= from_ns && sample.time_ns <= to_ns) sample = absent(sample.time_ns);
  }
}

/// Returns the start of a gap in the readings that lasts to the end or is long.
std::optional<TimeNs> silent_since(const std::vector<ImuSample>& unit) {
  std::size_t from = unit.size();
  for (std::size_t k = 0; k <= unit.size(); ++k) {
    const bool here = k < unit.size() && !is_finite(unit[k]);
    if (here && from == unit.size()) from = k;
    if (here || from == unit.size()) continue;
    if (seconds(unit[k - 1].time_ns - unit[from].time_ns) >= kSilentReportedS) return unit[from].time_ns;
    from = unit.size();
  }
  return std::nullopt;
}

Status frozen_in_all(const FrozenAxis& axis) {
  constexpr const char* kFields[2][3] = {{"repeat time of gyro x in s, with no healthy IMU available",
                                          "repeat time of gyro y in s, with no healthy IMU available",
                                          "repeat time of gyro z in s, with no healthy IMU available"},
                                         {"repeat time of accel x in s, with no healthy IMU available",
                                          "repeat time of accel y in s, with no healthy IMU available",
                                          "repeat time of accel z in s, with no healthy IMU available"}};
  const char* field = kFields[axis.triad == Triad::gyro ? 0 : 1][axis.axis];
  return {Trouble::out_of_range, field, seconds(axis.to_ns - axis.from_ns), FrozenAxes::Params{}.frozen_s};
}

/// Marks readings as absent while an axis of their IMU is frozen, and reports the frozen axis. Returns an error if no
/// IMU remains.
Status exclude_frozen(Units& units, std::vector<Doubt>& out) {
  const TimeNs start_ns = units.samples[0].front().time_ns;
  std::optional<FrozenAxis> any;
  for (std::size_t unit = 0; unit < units.names.size(); ++unit) {
    for (const FrozenAxis& axis : units.frozen[unit]) {
      silence(units.samples[unit], axis.from_ns, axis.to_ns);
      out.push_back(
          {Doubt::About::unit_frozen, seconds(axis.from_ns - start_ns), units.names[unit] + "_" + to_string(axis)});
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

/// Sets the ranges stated for the device of the first IMU.
void give_ranges(const sim::ImuRecord& primary, MergedImus& out, ImuMerge::Params& params) {
  if (primary.stated_gyro_range_rad_s > 0.0) out.gyro_range_rad_s = unsaturated_range(primary.stated_gyro_range_rad_s);
  if (primary.stated_accel_range_m_s2 > 0.0) out.accel_range_m_s2 = unsaturated_range(primary.stated_accel_range_m_s2);
  params.gyro_range_rad_s = out.gyro_range_rad_s;
  params.accel_range_m_s2 = out.accel_range_m_s2;
}

void report_silent(const Units& units, std::vector<Doubt>& out) {
  const TimeNs start_ns = units.samples[0].front().time_ns;
  for (std::size_t k = 0; k < units.names.size(); ++k) {
    const std::optional<TimeNs> since_ns = silent_since(units.samples[k]);
    if (!since_ns) continue;
    out.push_back({Doubt::About::unit_silent, seconds(*since_ns - start_ns), units.names[k]});
  }
}

void erase_unit(Units& units, std::size_t unit) {
  const auto at = static_cast<std::ptrdiff_t>(unit);
  units.names.erase(units.names.begin() + at);
  units.T_BI.erase(units.T_BI.begin() + at);
  units.samples.erase(units.samples.begin() + at);
  units.gyro_elements.erase(units.gyro_elements.begin() + at);
  units.accel_elements.erase(units.accel_elements.begin() + at);
}

/// Marks the readings of faulty IMUs as absent from the start of the fault. Returns true if any IMU is faulty.
bool leave_out_found(const ImuMerge::State& state, Units& units, std::vector<Doubt>& out) {
  const TimeNs start_ns = units.samples[0].front().time_ns;
  bool any = false;
  for (std::size_t k = units.names.size(); k-- > 0;) {
    const ImuMerge::Unit& unit = state.units[k];
    if (unit.frozen) {
      any = true;
      silence(units.samples[k], unit.frozen_since_ns);
      out.push_back({Doubt::About::unit_frozen, seconds(unit.frozen_since_ns - start_ns), units.names[k]});
    } else if (unit.disagrees) {
      any = true;
      out.push_back({Doubt::About::unit_disagrees, seconds(unit.disagrees_since_ns - start_ns), units.names[k]});
      erase_unit(units, k);
    }
  }
  return any;
}

/// Reports the estimated calibration of the IMUs, and the position of the merged IMU between them.
void report_units(const ImuMerge& merge, const ImuMerge::State& state, const Units& units, MergedImus& out) {
  out.units = static_cast<int>(units.names.size());
  out.lever_arm_m = merge.p_C_m();
  out.arm_share = ImuMerge::arm_share(state);
  out.other_sense = state.senses.detected();
  for (std::size_t unit = 0; unit < units.names.size(); ++unit) {
    const ImuMerge::Unit& learnt = state.units[unit];
    out.left_out += static_cast<double>(learnt.left_out);
    out.offset_max_s = std::max(out.offset_max_s, std::abs(learnt.offset_s()));
    if (units.names.size() < 2) continue;
    constexpr int kOffset = ImuMerge::kErrors - 1;
    out.each.push_back({units.names[unit], learnt.offset_s(), std::sqrt(std::max(0.0, learnt.P(kOffset, kOffset))),
                        learnt.x.head<3>().norm()});
  }
}

}  // namespace

Status merge_imus(const sim::Sensors& sensors, MergedImus& out) {
  out = {};
  Units units;
  if (Status status = units_of(sensors, units); !status.ok()) return status;
  out.resampled = units.resampled;
  out.beyond_range = units.beyond_range;
  ImuMerge::Params params;
  params.gap_max_s = bridge::kGapMaxS;
  give_ranges(sensors.imus.front(), out, params);
  report_silent(units, out.out);
  if (Status status = exclude_frozen(units, out.out); !status.ok()) return status;

  give_units(units, params);
  auto state = std::make_unique<ImuMerge::State>();
  if (Status status = run(ImuMerge(params), units, *state, out.samples); !status.ok()) return status;
  const bool anew = leave_out_found(*state, units, out.out);
  give_units(units, params);
  const ImuMerge merge(params);
  if (anew) {
    *state = {};
    if (Status status = run(merge, units, *state, out.samples); !status.ok()) return status;
  }
  report_units(merge, *state, units, out);
  return {};
}

}  // namespace tumble::scenarios
