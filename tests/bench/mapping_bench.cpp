// SPDX-License-Identifier: BSD-3-Clause
// One sweep of 28 800 points through the odometry on one core, everything included, in the midst of a tumble at 15
// rad/s; and its parts. The odometry is copied from a saved state before each run, outside of the time taken.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/plane_fit.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace {

using tumble::LidarInertialOdometry;

constexpr int kSweeps = 14;
constexpr int kColumns = 1800;

/// An odometry that has seen kSweeps sweeps and the IMU of the next, and that next sweep.
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
      LidarInertialOdometry::SweepReport report;
      if (i < kSweeps) (void)add(odometry, i, report);
    }
  }

  tumble::Status add(LidarInertialOdometry& to, int sweep, LidarInertialOdometry::SweepReport& report) const {
    return to.add_sweep(sweep * tumble::test::kSweep_ns, (sweep + 1) * tumble::test::kSweep_ns, next, report);
  }
};

void sweep_of_28800_points(benchmark::State& state) {
  LidarInertialOdometry::Params params;
  params.sweep_voxel_m = 0.01 * static_cast<double>(state.range(0));
  const Saved saved(params);
  LidarInertialOdometry::SweepReport report;
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
  state.counters["registered"] = static_cast<double>(report.points_registered);
  state.counters["iterations"] = report.iterations;
  state.counters["added"] = static_cast<double>(report.map_points_added);
}
BENCHMARK(sweep_of_28800_points)->Arg(25)->Arg(50)->Unit(benchmark::kMillisecond)->ArgName("voxel_cm");

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
  tumble::Neighbours found;
  std::uint32_t index = 0;
  const bool with_plane = state.range(0) != 0;
  for (auto _ : state) {
    do {
      index = (index + 7919) % map.index_end();
    } while (!map.exists(index));
    map.nearest(map.position_W_m(index) + Eigen::Vector3f(0.05f, -0.04f, 0.06f), 12, 1.0f, found);
    if (with_plane) benchmark::DoNotOptimize(tumble::fit_plane(map, found, tumble::PlaneBounds{}));
    benchmark::DoNotOptimize(found);
  }
}
BENCHMARK(nearest_neighbours_and_plane)->Arg(0)->Arg(1)->ArgName("plane");

}  // namespace
