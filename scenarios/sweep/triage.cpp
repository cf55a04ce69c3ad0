// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/triage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "sim/lidar/surface.hpp"

namespace tumble::scenarios {

namespace {

TriageRow row_of(const std::string& input, const std::string& doc, Outcome outcome, const FailureGoal& failure) {
  TriageRow row{input, doc, std::move(outcome), false};
  row.fails = failure.holds(row.outcome);
  return row;
}

}  // namespace

std::vector<TriageRow> triage(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
                              const TriageOptions& options) {
  require_applies(method, scenario);
  const SimulatedDraw draw = simulate_draw(data, scenario, seed, 1);
  std::optional<sim::Surface> surface;
  if (method.info.kind == Kind::slam) surface.emplace(*draw.built);
  const sim::Surface* true_surface = surface ? &*surface : nullptr;

  std::vector<TriageRow> rows;
  const auto add = [&](TriageRow row) {
    if (options.on_row) options.on_row(row);
    rows.push_back(std::move(row));
  };
  if (options.on_run) options.on_run("none");
  add(row_of("none", "unchanged recording", run_isolated(method, draw, draw, true_surface, options.timeout_s),
             options.failure));
  for (const TrueInput& input : true_inputs()) {
    SimulatedDraw cured = draw;
    if (!input.replace(cured.recording.sensors, draw.recording.truth)) continue;
    if (options.on_run) options.on_run(input.name);
    add(row_of(input.name, input.doc,
               run_isolated(method, cured, scored_by(draw, cured), true_surface, options.timeout_s), options.failure));
  }
  return rows;
}

namespace {

using Readings = std::vector<Eigen::Vector3d>;

constexpr std::uint8_t kAccelClipFlags = 0b111000;
constexpr std::uint32_t kInstant_ns = 1000;  // too short for motion

double largest(const Readings& readings) {
  double largest = 0.0;
  for (const Eigen::Vector3d& reading : readings) largest = std::max(largest, reading.lpNorm<Eigen::Infinity>());
  return largest;
}

/// Returns a stated range that exceeds every reading, so that no reading counts as clipped.
double beyond(double stated, const Readings& readings) {
  return stated > 0.0 ? std::max(stated, 1.1 * largest(readings)) : stated;
}

bool replace_gyro(sim::ImuRecord& imu, const Readings& readings) {
  if (readings.size() != imu.gyro_rad_s.size() || readings == imu.gyro_rad_s) return false;
  imu.gyro_rad_s = readings;
  imu.stated_gyro_range_rad_s = beyond(imu.stated_gyro_range_rad_s, readings);
  for (std::uint8_t& flags : imu.clip_flags) flags = static_cast<std::uint8_t>(flags & ~kGyroClipFlags);
  return true;
}

bool replace_accel(sim::ImuRecord& imu, const Readings& readings) {
  if (readings.size() != imu.accel_m_s2.size() || readings == imu.accel_m_s2) return false;
  imu.accel_m_s2 = readings;
  imu.stated_accel_range_m_s2 = beyond(imu.stated_accel_range_m_s2, readings);
  for (std::uint8_t& flags : imu.clip_flags) flags = static_cast<std::uint8_t>(flags & ~kAccelClipFlags);
  return true;
}

template <typename Replace>
bool each_imu(sim::Sensors& sensors, const sim::Truth& truth, Replace&& replace) {
  bool changed = false;
  for (std::size_t i = 0; i < std::min(sensors.imus.size(), truth.imus.size()); ++i) {
    changed = replace(sensors.imus[i], truth.imus[i]) || changed;
  }
  return changed;
}

bool unclipped_gyro(sim::Sensors& sensors, const sim::Truth& truth) {
  return each_imu(sensors, truth, [](sim::ImuRecord& imu, const sim::ImuTruth& own) {
    return replace_gyro(imu, own.gyro_unclipped_rad_s);
  });
}

bool exact_gyro(sim::Sensors& sensors, const sim::Truth& truth) {
  return each_imu(sensors, truth,
                  [](sim::ImuRecord& imu, const sim::ImuTruth& own) { return replace_gyro(imu, own.rate_rad_s); });
}

bool unclipped_accel(sim::Sensors& sensors, const sim::Truth& truth) {
  return each_imu(sensors, truth, [](sim::ImuRecord& imu, const sim::ImuTruth& own) {
    return replace_accel(imu, own.accel_unclipped_m_s2);
  });
}

bool exact_accel(sim::Sensors& sensors, const sim::Truth& truth) {
  return each_imu(sensors, truth, [](sim::ImuRecord& imu, const sim::ImuTruth& own) {
    return replace_accel(imu, own.specific_force_m_s2);
  });
}

bool exact_mounting(sim::Sensors& sensors, const sim::Truth& truth) {
  bool changed = each_imu(sensors, truth, [](sim::ImuRecord& imu, const sim::ImuTruth& own) {
    const bool differs = imu.T_BI.matrix() != own.T_BI.matrix();
    imu.T_BI = own.T_BI;
    return differs;
  });
  for (std::size_t i = 0; i < std::min(sensors.lidars.size(), truth.lidars.size()); ++i) {
    changed = changed || sensors.lidars[i].T_BL.matrix() != truth.lidars[i].T_BL.matrix();
    sensors.lidars[i].T_BL = truth.lidars[i].T_BL;
  }
  for (std::size_t i = 0; i < std::min(sensors.series.size(), truth.series.size()); ++i) {
    changed = changed || sensors.series[i].T_BX.matrix() != truth.series[i].T_BX.matrix();
    sensors.series[i].T_BX = truth.series[i].T_BX;
  }
  return changed;
}

bool exact_stamps(sim::Sensors& sensors, const sim::Truth& truth) {
  bool changed = false;
  const std::int64_t end_ns = static_cast<std::int64_t>(truth.q_WB.size() - 1) * truth.period_ns;
  for (sim::ImuRecord& imu : sensors.imus) {
    if (imu.period_ns <= 0 || static_cast<std::int64_t>(imu.time_ns.size()) != end_ns / imu.period_ns) continue;
    for (std::size_t i = 0; i < imu.time_ns.size(); ++i) {
      const std::int64_t exact_ns = static_cast<std::int64_t>(i + 1) * imu.period_ns;
      changed = changed || imu.time_ns[i] != exact_ns;
      imu.time_ns[i] = exact_ns;
    }
  }
  return changed;
}

Eigen::Isometry3d pose_of(const TruthTrack& track, std::int64_t time_ns) {
  const PoseState pose = track.pose(std::min(time_ns, track.last_ns()));
  Eigen::Isometry3d T_WL = Eigen::Isometry3d::Identity();
  T_WL.linear() = pose.orientation_W.toRotationMatrix();
  T_WL.translation() = pose.position_W_m;
  return T_WL;
}

bool exact_ranges(sim::Sensors& sensors, const sim::Truth& truth) {
  if (sensors.lidars.empty() || truth.lidars.empty()) return false;
  sim::LidarRecord& lidar = sensors.lidars.front();
  const TruthTrack track(truth, Frame::lidar);
  for (std::size_t sweep = 0; sweep < lidar.sweep_start_ns.size(); ++sweep) {
    for (std::uint64_t i = lidar.sweep_first[sweep]; i < lidar.sweep_first[sweep + 1]; ++i) {
      const Eigen::Isometry3d T_WL = pose_of(track, lidar.sweep_start_ns[sweep] + lidar.offset_ns[i]);
      const Eigen::Vector3f exact_L_m = (T_WL.inverse() * truth.lidars.front().hit_W_m[i].cast<double>()).cast<float>();
      lidar.range_m[i] += exact_L_m.norm() - lidar.position_L_m[i].norm();
      lidar.position_L_m[i] = exact_L_m;
    }
  }
  return !lidar.range_m.empty();
}

/// Removes the motion distortion of each sweep. The true poses transform all points of a sweep to the sensor pose at
/// the last point.
bool unbent_sweeps(sim::Sensors& sensors, const sim::Truth& truth) {
  if (sensors.lidars.empty() || truth.lidars.empty()) return false;
  sim::LidarRecord& lidar = sensors.lidars.front();
  const TruthTrack track(truth, Frame::lidar);
  for (std::size_t sweep = 0; sweep < lidar.sweep_start_ns.size(); ++sweep) {
    const std::uint64_t first = lidar.sweep_first[sweep], end = lidar.sweep_first[sweep + 1];
    if (first == end) continue;
    const std::uint32_t last_ns = *std::max_element(lidar.offset_ns.begin() + static_cast<std::ptrdiff_t>(first),
                                                    lidar.offset_ns.begin() + static_cast<std::ptrdiff_t>(end));
    const std::uint32_t span_ns = std::min(last_ns, kInstant_ns);
    const std::int64_t start_ns = lidar.sweep_start_ns[sweep];
    for (std::uint64_t i = first; i < end; ++i) {
      const Eigen::Isometry3d T_WL = pose_of(track, start_ns + lidar.offset_ns[i]);
      lidar.offset_ns[i] = last_ns - span_ns + static_cast<std::uint32_t>(span_ns * (i - first) / (end - first));
      const Eigen::Isometry3d T_LW = pose_of(track, start_ns + lidar.offset_ns[i]).inverse();
      lidar.position_L_m[i] = (T_LW * (T_WL * lidar.position_L_m[i].cast<double>())).cast<float>();
    }
  }
  return !lidar.range_m.empty();
}

bool exact_series(sim::Sensors& sensors, const sim::Truth& truth) {
  bool changed = false;
  for (std::size_t i = 0; i < std::min(sensors.series.size(), truth.series.size()); ++i) {
    std::vector<sim::Quantity>& read = sensors.series[i].quantities;
    const std::vector<sim::QuantityTruth>& exact = truth.series[i].quantities;
    for (std::size_t q = 0; q < std::min(read.size(), exact.size()); ++q) {
      if (read[q].values.size() != exact[q].values.size() || read[q].values == exact[q].values) continue;
      read[q].values = exact[q].values;
      changed = true;
    }
  }
  return changed;
}

/// Replaces all inputs by true values. Range errors are corrected before the motion distortion, because the correction
/// of ranges needs the original time of each point.
bool everything(sim::Sensors& sensors, const sim::Truth& truth) {
  bool changed = false;
  for (const auto& replace :
       {exact_gyro, exact_accel, exact_mounting, exact_stamps, exact_ranges, unbent_sweeps, exact_series}) {
    changed = replace(sensors, truth) || changed;
  }
  return changed;
}

}  // namespace

std::span<const TrueInput> true_inputs() {
  static const std::array kInputs = {
      TrueInput{"gyro_unclipped", "replaces the gyro readings by readings without saturation; all other errors remain",
                unclipped_gyro},
      TrueInput{"gyro_exact", "replaces each gyro reading by the true mean rate of the sample", exact_gyro},
      TrueInput{"accel_unclipped",
                "replaces the accelerometer readings by readings without saturation; all other errors remain",
                unclipped_accel},
      TrueInput{"accel_exact", "replaces each accelerometer reading by the true mean specific force of the sample",
                exact_accel},
      TrueInput{"mounting_exact", "replaces the calibration by the true positions and orientations of all sensors",
                exact_mounting},
      TrueInput{"stamps_exact", "replaces the time stamps of the IMU by the true times", exact_stamps},
      TrueInput{"lidar_ranges_exact", "replaces the lidar ranges by the true ranges", exact_ranges},
      TrueInput{"lidar_unbent",
                "replaces the sweeps by sweeps without motion distortion (all points within a microsecond); the range "
                "errors remain",
                unbent_sweeps},
      TrueInput{"series_exact", "removes the errors of all sensors other than IMU and lidar", exact_series},
      TrueInput{"all", "replaces all inputs of the method by their true values at once", everything},
  };
  return kInputs;
}

}  // namespace tumble::scenarios
