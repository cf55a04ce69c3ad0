// SPDX-License-Identifier: BSD-3-Clause
// The program measures the odometry on one core with sweeps of 28 800 points in a tumble at 15 rad/s. The first
// measurement repeats one sweep (each run copies the odometry from a saved state, outside of the measured time), and
// the second uses all sweeps and gives median and worst. Others measure the parts, and ten minutes of small sweeps,
// whose cost and memory must not grow.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

#include "tests/estimator/mapping/endless_corridor.hpp"
#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace {

using tumble::LidarInertialOdometry;

constexpr int kSweeps = 14;
constexpr int kColumns = 1800;

/// Saved contains an odometry after kSweeps sweeps and the IMU data of the next sweep, and this next sweep.
struct Saved {
  LidarInertialOdometry odometry;
  std::vector<tumble::LidarPoint> next;

  explicit Saved(const LidarInertialOdometry::Params& params) : odometry(params) {
    const tumble::test::Motion motion;
    const tumble::test::Room room = tumble::test::Room::box_with_pillars();
    const std::vector<tumble::ImuSample> imu = tumble::test::make_imu(motion, 0.1 * (kSweeps + 1));
    for (int i = 0; i <= kSweeps; ++i) {
      for (int k = 10 * i; k < 10 * (i + 1); ++k) {
        const tumble::ImuSample& sample = imu[static_cast<std::size_t>(k)];
        (void)odometry.add_imu(sample, tumble::test::believe(sample));
      }
      next = tumble::test::make_sweep(room, motion, params.T_IL, i, 0.02, kColumns);
      LidarInertialOdometry::SweepResult report;
      if (i < kSweeps) (void)add(odometry, i, report);
    }
  }

  tumble::Status add(LidarInertialOdometry& to, int sweep, LidarInertialOdometry::SweepResult& report) const {
    return to.add_sweep(sweep * tumble::test::kSweep_ns, (sweep + 1) * tumble::test::kSweep_ns, next, report);
  }
};

void sweep_of_28800_points(benchmark::State& state) {
  LidarInertialOdometry::Params params;
  params.sweep_voxel_m = 0.01 * static_cast<double>(state.range(0));
  const Saved saved(params);
  LidarInertialOdometry::SweepResult report;
  LidarInertialOdometry odometry(saved.odometry);
  for (auto _ : state) {
    state.PauseTiming();
    odometry = saved.odometry;
    state.ResumeTiming();
    if (!saved.add(odometry, kSweeps, report).ok() || report.verdict == tumble::SweepVerdict::rejected) {
      state.SkipWithError("the sweep was not registered");
      break;
    }
  }
  state.counters["registered"] = static_cast<double>(report.points_after_downsampling);
  state.counters["iterations"] = report.iterations;
  state.counters["added"] = static_cast<double>(report.map_points_added);
}
BENCHMARK(sweep_of_28800_points)->Arg(25)->Arg(50)->Unit(benchmark::kMillisecond)->ArgName("voxel_cm");

/// Returns the elapsed processor time, which other processes on the machine do not lengthen.
double since_ms(std::clock_t start) {
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Returns the median of all values, which the function may reorder.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the settings of the method: saturation deficits of clipped axes and the calibration are also unknowns.
LidarInertialOdometry::Params all_unknowns() {
  LidarInertialOdometry::Params params;
  params.expert.saturated_imu.estimate_deficit = true;
  params.mount_sigma_rad = 0.01;
  params.mount_sigma_m = 0.006;
  params.time_offset_sigma_s = 0.003;
  params.expert.gravity_sigma_m_s2 = 0.03;
  return params;
}

tumble::AngularRateState on_the_rail(const tumble::ImuSample& sample) {
  constexpr double kRail_rad_s = 10.5;
  tumble::AngularRateState rate = tumble::test::believe(sample);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(rate.w_WI_I_rad_s[axis]) >= kRail_rad_s) rate.clipped_axes |= static_cast<std::uint8_t>(1 << axis);
  }
  return rate;
}

void tumble_of_28800_points_a_sweep(benchmark::State& state) {
  constexpr int kCount = 30;
  const LidarInertialOdometry::Params params = state.range(0) != 0 ? all_unknowns() : LidarInertialOdometry::Params{};
  const tumble::test::Motion motion;
  const tumble::test::Room room = tumble::test::Room::box_with_pillars();
  const std::vector<tumble::ImuSample> imu = tumble::test::make_imu(motion, 0.1 * kCount);
  std::vector<std::vector<tumble::LidarPoint>> sweeps;
  for (int i = 0; i < kCount; ++i) {
    sweeps.push_back(tumble::test::make_sweep(room, motion, params.T_IL, i, 0.02, kColumns));
  }
  std::vector<double> times_ms;
  for (auto _ : state) {
    LidarInertialOdometry odometry(params);
    for (int i = 0; i < kCount; ++i) {
      LidarInertialOdometry::SweepResult report;
      const std::clock_t start = std::clock();
      for (int k = 10 * i; k < 10 * (i + 1); ++k) {
        (void)odometry.add_imu(imu[static_cast<std::size_t>(k)], on_the_rail(imu[static_cast<std::size_t>(k)]));
      }
      const tumble::Status status = odometry.add_sweep(i * tumble::test::kSweep_ns, (i + 1) * tumble::test::kSweep_ns,
                                                       sweeps[static_cast<std::size_t>(i)], report);
      times_ms.push_back(since_ms(start));
      if (!status.ok() || report.verdict == tumble::SweepVerdict::rejected) {
        state.SkipWithError("a sweep was not registered");
        return;
      }
    }
  }
  state.counters["median_ms"] = median(times_ms);
  state.counters["worst_ms"] = *std::max_element(times_ms.begin(), times_ms.end());
}
BENCHMARK(tumble_of_28800_points_a_sweep)->Arg(0)->Arg(1)->Iterations(2)->Unit(benchmark::kMillisecond)->ArgName("all");

/// The sensor is moved elsewhere in the middle of a tumble, so every sweep is searched in the map without success.
void search_of_28800_points_a_sweep(benchmark::State& state) {
  constexpr int kKnown = 12, kCount = 32;
  const LidarInertialOdometry::Params params = all_unknowns();
  const tumble::test::Motion motion;
  tumble::test::Motion elsewhere = motion;
  elsewhere.spin_rad_s = 11.0;
  const std::vector<tumble::ImuSample> imu = tumble::test::make_imu(motion, 0.1 * kCount);
  std::vector<double> times_ms;
  for (auto _ : state) {
    LidarInertialOdometry odometry(params);
    for (int i = 0; i < kCount; ++i) {
      const bool known = i < kKnown;
      const auto points = tumble::test::make_sweep(tumble::test::Room::box_with_pillars(), known ? motion : elsewhere,
                                                   params.T_IL, i, 0.02, kColumns);
      LidarInertialOdometry::SweepResult report;
      for (int k = 10 * i; k < 10 * (i + 1); ++k) {
        (void)odometry.add_imu(imu[static_cast<std::size_t>(k)], on_the_rail(imu[static_cast<std::size_t>(k)]));
      }
      const std::clock_t start = std::clock();
      (void)odometry.add_sweep(i * tumble::test::kSweep_ns, (i + 1) * tumble::test::kSweep_ns, points, report);
      if (!known && report.verdict == tumble::SweepVerdict::rejected) times_ms.push_back(since_ms(start));
    }
  }
  if (times_ms.empty()) {
    state.SkipWithError("no sweep was lost");
    return;
  }
  state.counters["lost"] = static_cast<double>(times_ms.size());
  state.counters["median_ms"] = median(times_ms);
  state.counters["worst_ms"] = *std::max_element(times_ms.begin(), times_ms.end());
}
BENCHMARK(search_of_28800_points_a_sweep)->Iterations(1)->Unit(benchmark::kMillisecond);

void ten_minutes_of_small_sweeps(benchmark::State& state) {
  constexpr int kCount = 6000, kMinute = 600, kSettled = 500;
  for (auto _ : state) {
    LidarInertialOdometry odometry(tumble::test::corridor_params());
    tumble::test::EndlessCorridor corridor(400);
    std::vector<double> first_ms, last_ms;
    std::size_t first_bytes = 0, last_bytes = 0;
    for (int i = 0; i < kCount; ++i) {
      for (const tumble::ImuSample& sample : corridor.advance()) {
        (void)odometry.add_imu(sample, tumble::test::believe(sample));
      }
      const std::vector<tumble::LidarPoint> points = corridor.points();
      LidarInertialOdometry::SweepResult report;
      const std::clock_t start = std::clock();
      (void)odometry.add_sweep(corridor.start_ns(), corridor.end_ns(), points, report);
      const double taken_ms = since_ms(start);
      if (i >= kSettled && i < kSettled + kMinute) {
        first_ms.push_back(taken_ms);
        first_bytes = std::max(first_bytes, odometry.map_memory_bytes());
      } else if (i >= kCount - kMinute) {
        last_ms.push_back(taken_ms);
        last_bytes = std::max(last_bytes, odometry.map_memory_bytes());
      }
    }
    state.counters["first_minute_ms"] = median(first_ms);
    state.counters["last_minute_ms"] = median(last_ms);
    state.counters["first_minute_bytes"] = static_cast<double>(first_bytes);
    state.counters["last_minute_bytes"] = static_cast<double>(last_bytes);
  }
}
BENCHMARK(ten_minutes_of_small_sweeps)->Iterations(1)->Unit(benchmark::kMillisecond);

void nearest_neighbours_and_plane(benchmark::State& state) {
  tumble::VoxelMap map({0.5, 0.1});
  const tumble::test::Motion motion;
  for (int i = 5; i < 15; ++i) {
    for (const auto& p :
         tumble::test::make_sweep(tumble::test::Room::box_with_pillars(), motion, Eigen::Isometry3d::Identity(), i)) {
      const Eigen::Isometry3d T = motion.pose(0.1 * i + 1e-9 * p.offset_ns);
      map.insert((T * p.position_L_m.cast<double>()).cast<float>(), 0.02f, 0);
    }
  }
  tumble::NearestNeighbours found;
  std::uint32_t index = 0;
  const bool with_plane = state.range(0) != 0;
  for (auto _ : state) {
    do {
      index = (index + 7919) % map.index_end();
    } while (!map.exists(index));
    map.nearest(map.position_W_m(index) + Eigen::Vector3f(0.05f, -0.04f, 0.06f), 12, 1.0f, found);
    if (with_plane) benchmark::DoNotOptimize(tumble::fit_plane(map, found, tumble::PlaneFitBounds{}));
    benchmark::DoNotOptimize(found);
  }
}
BENCHMARK(nearest_neighbours_and_plane)->Arg(0)->Arg(1)->ArgName("plane");

}  // namespace
