// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/lidar_simulation.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/lidar/range_errors.hpp"
#include "sim/lidar/ray_scene.hpp"
#include "sim/lidar/track_cursor.hpp"

namespace tumble::sim {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// The returns of one sweep. Sized once for all firings, then reused.
struct Sweep {
  std::vector<Vector3f> position_L_m, hit_W_m;
  std::vector<float> range_m, intensity;
  std::vector<std::uint32_t> offset_ns;
  std::vector<std::uint16_t> ring;
  std::vector<std::int32_t> surface_id;
  std::size_t count = 0;

  void make_room(std::size_t points) {
    count = 0;
    if (position_L_m.size() >= points) return;
    position_L_m.resize(points);
    hit_W_m.resize(points);
    range_m.resize(points);
    intensity.resize(points);
    offset_ns.resize(points);
    ring.resize(points);
    surface_id.resize(points);
  }
};

std::unique_ptr<BeamPattern> pattern_of(const SensorSpec& sensor) {
  if (sensor.kind == "spinning_lidar") return std::make_unique<SpinningPattern>(sensor.values);
  if (sensor.kind == "rosette_lidar") return std::make_unique<RosettePattern>(sensor.values);
  throw InvalidSituation("sensor '" + sensor.name + "': '" + sensor.kind + "' is no kind of lidar");
}

/// Casts one lidar. Const throughout: sweeps may run on several threads.
class Caster {
 public:
  Caster(const engine::World& world, const SensorSpec& sensor, const Isometry3d& T_BL, const MotionTrack& motion,
         std::uint64_t seed)
      : pattern_(pattern_of(sensor)),
        errors_(sensor.values, seed, sensor.name + ".range"),
        world_(static_geometry(world, HeightFieldSides::closed)),
        cage_(sensor.values.at("sees_own_cage") != 0.0 ? cage_geometry(world, T_BL.translation()) : SceneGeometry{}),
        R_BL_(T_BL.linear()),
        p_BL_m_(T_BL.translation()),
        // noise can bring back a hit from just beyond the limit
        reach_m_(static_cast<float>(sensor.values.at("range_max_m") + 10.0 * sensor.values.at("range_noise_m"))),
        motion_(motion) {}

  const BeamPattern& pattern() const { return *pattern_; }

  void cast_sweep(std::int64_t number, Sweep& sweep) const {
    const std::int64_t first = pattern_->first_slot(number), end = pattern_->first_slot(number + 1);
    sweep.make_room(static_cast<std::size_t>((end - first) * pattern_->lanes()));
    TrackCursor pose(motion_);
    Firings firings;
    RayPacket rays;
    for (std::int64_t slot = first; slot < end; slot += pattern_->slots_at_once()) {
      pattern_->fire(number, slot, static_cast<int>(std::min<std::int64_t>(pattern_->slots_at_once(), end - slot)),
                     firings);
      aim(firings, pose, rays);
      world_.cast(rays);
      collect(firings, rays, errors_.apply(rays, firings.slot), sweep);
    }
  }

 private:
  /// Rays in world axes, each from the pose at its own time; what the cage hides is marked as hit already.
  void aim(const Firings& firings, TrackCursor& pose, RayPacket& rays) const {
    rays.count = firings.count;
    for (int i = 0; i < firings.count; ++i) {
      const Vector3d origin_B =
          p_BL_m_ + R_BL_ * Vector3d(firings.origin_x_m[i], firings.origin_y_m[i], firings.origin_z_m[i]);
      const Vector3d direction_B =
          R_BL_ * Vector3d(firings.direction_x[i], firings.direction_y[i], firings.direction_z[i]);
      set_ray(rays, i, origin_B, direction_B);
      rays.range[i] = reach_m_;
      rays.surface_id[i] = kNothing;
    }
    if (!cage_.empty()) cage_.cast(rays);
    for (int i = 0; i < firings.count; ++i) {
      pose.seek(firings.time_ns[i]);
      const Vector3d origin_B =
          p_BL_m_ + R_BL_ * Vector3d(firings.origin_x_m[i], firings.origin_y_m[i], firings.origin_z_m[i]);
      const Vector3d direction_B =
          R_BL_ * Vector3d(firings.direction_x[i], firings.direction_y[i], firings.direction_z[i]);
      set_ray(rays, i, pose.position_m() + pose.to_world(origin_B), pose.to_world(direction_B));
    }
  }

  static void set_ray(RayPacket& rays, int lane, const Vector3d& origin, const Vector3d& direction) {
    rays.origin_x[lane] = static_cast<float>(origin.x());
    rays.origin_y[lane] = static_cast<float>(origin.y());
    rays.origin_z[lane] = static_cast<float>(origin.z());
    rays.direction_x[lane] = static_cast<float>(direction.x());
    rays.direction_y[lane] = static_cast<float>(direction.y());
    rays.direction_z[lane] = static_cast<float>(direction.z());
  }

  static void collect(const Firings& firings, const RayPacket& rays, const Returns& returns, Sweep& sweep) {
    for (int i = 0; i < firings.count; ++i) {
      if (!returns.kept[i]) continue;
      const std::size_t at = sweep.count++;
      const double range = returns.range_m[i];
      sweep.position_L_m[at] = Vector3f(static_cast<float>(firings.origin_x_m[i] + range * firings.direction_x[i]),
                                        static_cast<float>(firings.origin_y_m[i] + range * firings.direction_y[i]),
                                        static_cast<float>(firings.origin_z_m[i] + range * firings.direction_z[i]));
      sweep.hit_W_m[at] = Vector3f(rays.origin_x[i] + rays.range[i] * rays.direction_x[i],
                                   rays.origin_y[i] + rays.range[i] * rays.direction_y[i],
                                   rays.origin_z[i] + rays.range[i] * rays.direction_z[i]);
      sweep.range_m[at] = returns.range_m[i];
      sweep.intensity[at] = returns.intensity[i];
      sweep.offset_ns[at] = firings.offset_ns[i];
      sweep.ring[at] = firings.ring[i];
      sweep.surface_id[at] = rays.surface_id[i];
    }
  }

  std::unique_ptr<BeamPattern> pattern_;
  RangeErrors errors_;
  RayScene world_, cage_;
  Eigen::Matrix3d R_BL_;
  Vector3d p_BL_m_;
  float reach_m_;
  MotionTrack motion_;
};

template <typename T>
void append(const std::vector<T>& from, std::size_t count, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
}

void append_sweep(const Sweep& sweep, LidarRecord& record, LidarTruth& truth) {
  append(sweep.position_L_m, sweep.count, record.position_L_m);
  append(sweep.range_m, sweep.count, record.range_m);
  append(sweep.intensity, sweep.count, record.intensity);
  append(sweep.offset_ns, sweep.count, record.offset_ns);
  append(sweep.ring, sweep.count, record.ring);
  append(sweep.hit_W_m, sweep.count, truth.hit_W_m);
  append(sweep.surface_id, sweep.count, truth.surface_id);
}

/// Sweeps that end within the motion; its last sample holds for one period more.
std::int64_t whole_sweeps(const MotionTrack& motion, std::int64_t sweep_period_ns) {
  if (motion.period_ns <= 0 || motion.p_WB_m.size() != motion.q_WB.size()) {
    throw std::invalid_argument("simulate_lidar: motion needs a positive period and as many attitudes as positions");
  }
  if (motion.p_WB_m.size() < 2) return 0;
  return static_cast<std::int64_t>(motion.p_WB_m.size()) * motion.period_ns / sweep_period_ns;
}

}  // namespace

void simulate_lidar(const engine::World& world, const SensorSpec& sensor, const Isometry3d& T_BL,
                    const MotionTrack& motion, std::uint64_t seed, int threads, LidarRecord& record,
                    LidarTruth& truth) {
  const Caster caster(world, sensor, T_BL, motion, seed);
  const std::int64_t period_ns = caster.pattern().sweep_period_ns();
  const std::int64_t sweeps = whole_sweeps(motion, period_ns);

  const Isometry3d calibration = record.T_BL;
  record = LidarRecord{};
  record.T_BL = calibration;
  truth = LidarTruth{};
  record.name = truth.name = sensor.name;
  record.device = sensor.device;
  record.sweep_period_ns = period_ns;
  truth.T_BL = T_BL;
  record.sweep_first.push_back(0);

  // a few sweeps at a time, so that the memory beside the record stays small
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  threads = std::clamp(threads, 1, static_cast<int>(allowed));  // oneTBB prints a warning when asked for more
  const std::int64_t at_once = 2 * threads;
  std::vector<Sweep> done(static_cast<std::size_t>(at_once));
  tbb::task_arena arena(threads);
  for (std::int64_t first = 0; first < sweeps; first += at_once) {
    const std::int64_t count = std::min(at_once, sweeps - first);
    arena.execute([&] {
      tbb::parallel_for(std::int64_t{0}, count,
                        [&](std::int64_t i) { caster.cast_sweep(first + i, done[static_cast<std::size_t>(i)]); });
    });
    for (std::int64_t i = 0; i < count; ++i) {
      append_sweep(done[static_cast<std::size_t>(i)], record, truth);
      record.sweep_start_ns.push_back((first + i) * period_ns);
      record.sweep_first.push_back(record.position_L_m.size());
    }
  }
}

}  // namespace tumble::sim
