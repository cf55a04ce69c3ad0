// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/lidar_simulation.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/lidar/sweep_caster.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

namespace {

template <typename T>
void append(const std::vector<T>& from, std::size_t count, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
}

void reserve(std::size_t points, LidarRecord& record, LidarTruth& truth) {
  record.position_L_m.reserve(points);
  record.range_m.reserve(points);
  record.intensity.reserve(points);
  record.offset_ns.reserve(points);
  record.ring.reserve(points);
  truth.hit_W_m.reserve(points);
  truth.surface_id.reserve(points);
}

void append_sweep(const SweepPoints& sweep, LidarRecord& record, LidarTruth& truth) {
  append(sweep.position_L_m, sweep.count, record.position_L_m);
  append(sweep.range_m, sweep.count, record.range_m);
  append(sweep.intensity, sweep.count, record.intensity);
  append(sweep.offset_ns, sweep.count, record.offset_ns);
  append(sweep.ring, sweep.count, record.ring);
  append(sweep.hit_W_m, sweep.count, truth.hit_W_m);
  append(sweep.surface_id, sweep.count, truth.surface_id);
}

std::int64_t whole_sweeps(const MotionTrack& motion, std::int64_t sweep_period_ns) {
  if (motion.period_ns <= 0 || motion.p_WB_m.size() != motion.q_WB.size()) {
    throw std::invalid_argument(
        "simulate_lidar: the motion must have a positive period and as many attitudes as positions");
  }
  if (motion.p_WB_m.size() < 2) return 0;
  return static_cast<std::int64_t>(motion.p_WB_m.size()) * motion.period_ns / sweep_period_ns;
}

class Delivery {
 public:
  Delivery(const SensorSpec& sensor, std::uint64_t seed)
      : start_ns_(std::llround(sensor.values.at("start_delay_s") * 1e9)),
        lost_share_(sensor.values.at("sweep_dropout_share")),
        stream_(seed, sensor.name + ".sweeps") {}

  bool delivers(std::int64_t sweep_start_ns) {
    const bool lost = lost_share_ > 0.0 && stream_.uniform() < lost_share_;
    return !lost && sweep_start_ns >= start_ns_;
  }

 private:
  std::int64_t start_ns_;
  double lost_share_;
  Stream stream_;
};

}  // namespace

void simulate_lidar(const engine::World& world, const SensorSpec& sensor, const Eigen::Isometry3d& T_BL,
                    const MotionTrack& motion, std::uint64_t seed, int threads, LidarRecord& record,
                    LidarTruth& truth) {
  const SweepCaster caster(world, sensor, T_BL, motion, seed);
  const std::int64_t period_ns = caster.pattern().sweep_period_ns();
  const std::int64_t sweeps = whole_sweeps(motion, period_ns);

  const Eigen::Isometry3d calibration = record.T_BL;
  record = LidarRecord{};
  record.T_BL = calibration;
  truth = LidarTruth{};
  record.name = truth.name = sensor.name;
  record.device = sensor.device;
  record.sweep_period_ns = period_ns;
  truth.T_BL = T_BL;
  record.sweep_first.push_back(0);
  if (sweeps > 0) reserve(caster.firings(0) * static_cast<std::size_t>(sweeps), record, truth);

  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  threads = std::clamp(threads, 1, static_cast<int>(allowed));  // oneTBB warns above
  const std::int64_t at_once = 2 * threads;
  Delivery delivery(sensor, seed);
  std::vector<SweepPoints> done(static_cast<std::size_t>(at_once));
  tbb::task_arena arena(threads);
  for (std::int64_t first = 0; first < sweeps; first += at_once) {
    const std::int64_t count = std::min(at_once, sweeps - first);
    arena.execute([&] {
      tbb::parallel_for(std::int64_t{0}, count,
                        [&](std::int64_t i) { caster.cast_sweep(first + i, done[static_cast<std::size_t>(i)]); });
    });
    for (std::int64_t i = 0; i < count; ++i) {
      if (!delivery.delivers((first + i) * period_ns)) continue;
      append_sweep(done[static_cast<std::size_t>(i)], record, truth);
      record.sweep_start_ns.push_back((first + i) * period_ns);
      record.sweep_first.push_back(record.position_L_m.size());
    }
  }
}

}  // namespace tumble::sim
