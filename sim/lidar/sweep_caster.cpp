// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/sweep_caster.hpp"

#include <algorithm>

namespace tumble::sim {

namespace {

std::unique_ptr<BeamPattern> pattern_of(const SensorSpec& sensor) {
  if (sensor.kind == "spinning_lidar") return std::make_unique<SpinningPattern>(sensor.values);
  if (sensor.kind == "column_lidar") return std::make_unique<ColumnPattern>(sensor.values);
  if (sensor.kind == "rosette_lidar") return std::make_unique<RosettePattern>(sensor.values);
  throw InvalidSituation("sensor '" + sensor.name + "': '" + sensor.kind + "' is not a kind of lidar");
}

bool any_hit(const RayPacket& rays) {
  bool any = false;
  for (int s = 0; s < rays.count; ++s) any = any || rays.surface_id[s] != kNothing;
  return any;
}

struct ChannelReturns {
  alignas(64) float position_x[kLanes], position_y[kLanes], position_z[kLanes];  ///< in L
  Returns returns;
  Echoes echoes;
};

[[gnu::target("avx2")]] void place(const ChannelFirings& firings, ChannelReturns& out) {
  for (int s = 0; s < kLanes; ++s) {
    const double range = out.returns.range_m[s];
    out.position_x[s] = static_cast<float>(firings.origin_x_m[s] + range * firings.direction_x[s]);
    out.position_y[s] = static_cast<float>(firings.origin_y_m[s] + range * firings.direction_y[s]);
    out.position_z[s] = static_cast<float>(firings.origin_z_m[s] + range * firings.direction_z[s]);
  }
}

}  // namespace

void SweepPoints::make_room(std::size_t points) {
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

struct SweepCaster::Workspace {
  FiringBlock block;
  BlockPoses poses;
  ChannelFirings bent;
  std::array<RayPacket, kMaxBeamRays> beam;
  std::array<ChannelReturns, kMaxChannels> channel;
  int active_count = 0;
  std::array<int, kMaxChannels> active;
};

SweepCaster::SweepCaster(const engine::World& world, const SensorSpec& sensor, const Eigen::Isometry3d& T_BL,
                         const MotionTrack& motion, std::uint64_t seed)
    : pattern_(pattern_of(sensor)),
      errors_(sensor.values, seed, sensor.name + ".range"),
      spread_(sensor.values),
      world_(static_geometry(world, HeightFieldSides::closed)),
      cage_geometry_(sensor.values.at("sees_own_cage") != 0.0 ? cage_geometry(world, T_BL) : SceneGeometry{}),
      cage_(cage_geometry_),
      cage_mask_(cage_geometry_, *pattern_),
      T_BL_(T_BL),
      // Rays are longer than the range limit of the lidar, because range noise can move a hit from beyond the range
      // limit into the lidar's range.
      reach_m_(static_cast<float>(sensor.values.at("range_max_m") + 10.0 * sensor.values.at("range_noise_m"))),
      motion_(motion) {}

std::size_t SweepCaster::firings(std::int64_t sweep) const {
  return static_cast<std::size_t>((pattern_->first_slot(sweep + 1) - pattern_->first_slot(sweep)) *
                                  pattern_->channels());
}

void SweepCaster::cast_sweep(std::int64_t number, SweepPoints& points) const {
  const std::int64_t end = pattern_->first_slot(number + 1);
  points.make_room(firings(number));
  TrackCursor track(motion_, T_BL_);
  Workspace work;
  for (std::int64_t slot = pattern_->first_slot(number); slot < end; slot += kLanes) {
    pattern_->fire(number, slot, static_cast<int>(std::min<std::int64_t>(kLanes, end - slot)), work.block);
    work.poses.follow(*pattern_, work.block, track);
    cast_block(work);
    append(work, points);
  }
}

void SweepCaster::cast_channel(const FiringBlock& block, const BlockPoses& poses, int channel, bool meets_cage,
                               const ChannelFirings& firings, RayPacket& rays) const {
  rays.count = block.slots;
  for (int s = 0; s < kLanes; ++s) {
    rays.range[s] = reach_m_;
    rays.surface_id[s] = kNothing;
    rays.cosine[s] = rays.reflectivity[s] = 0.0f;
  }
  if (meets_cage) {
    aim_in_lidar_axes(firings, rays);
    cage_.cast(rays);
  }
  poses.aim(*pattern_, block, firings, channel, rays);
  world_.cast(rays);
}

void SweepCaster::cast_block(Workspace& work) const {
  work.active_count = 0;
  for (int c = 0; c < pattern_->channels(); ++c) {
    const ChannelFirings& firings = work.block.channel[c];
    ChannelReturns& out = work.channel[c];
    if (spread_.rays() == 1) {
      cast_channel(work.block, work.poses, c, cage_mask_.may_hit(work.block, c), firings, out.echoes.packet);
      if (!any_hit(out.echoes.packet)) continue;
      set_hits(out.echoes);
    } else {
      for (int k = 0; k < spread_.rays(); ++k) {
        spread_.bend(firings, k, work.bent);
        // Every ray of a wide beam is tested against the cage, because the cage mask is valid only for the central ray.
        cast_channel(work.block, work.poses, c, !cage_.empty(), work.bent, work.beam[k]);
      }
      spread_.merge(work.beam, out.echoes);
      if (!any_hit(out.echoes.packet)) continue;
    }
    errors_.apply(out.echoes.packet, static_cast<std::uint64_t>(work.block.first_slot) * kMaxChannels + c, out.returns);
    place(firings, out);
    work.active[work.active_count++] = c;
  }
}

void SweepCaster::append(const Workspace& work, SweepPoints& points) const {
  std::size_t at = points.count;
  for (int s = 0; s < work.block.slots; ++s) {
    for (int i = 0; i < work.active_count; ++i) {
      const int c = work.active[i];
      const ChannelReturns& from = work.channel[c];
      if (!from.returns.kept[s]) continue;
      points.position_L_m[at] = Eigen::Vector3f(from.position_x[s], from.position_y[s], from.position_z[s]);
      points.hit_W_m[at] = Eigen::Vector3f(from.echoes.hit_x[s], from.echoes.hit_y[s], from.echoes.hit_z[s]);
      points.range_m[at] = from.returns.range_m[s];
      points.intensity[at] = from.returns.intensity[s];
      points.offset_ns[at] = work.block.reported_ns[s] + static_cast<std::uint32_t>(pattern_->lag_ns(c));
      points.ring[at] = pattern_->ring(c, work.block.first_slot + s);
      points.surface_id[at] = from.echoes.packet.surface_id[s];
      ++at;
    }
  }
  points.count = at;
}

}  // namespace tumble::sim
