// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/lidar/beam_spread.hpp"
#include "sim/lidar/cage_mask.hpp"
#include "sim/lidar/lidar_simulation.hpp"
#include "sim/lidar/range_errors.hpp"
#include "sim/lidar/ray_aim.hpp"

namespace tumble::sim {

struct SweepPoints {
  std::vector<Eigen::Vector3f> position_L_m, hit_W_m;
  std::vector<float> range_m, intensity;
  std::vector<std::uint32_t> offset_ns;
  std::vector<std::uint16_t> ring;
  std::vector<std::int32_t> surface_id;
  std::size_t count = 0;

  void make_room(std::size_t points);
};

class SweepCaster {
 public:
  /// Builds the ray scene, which takes about 0.07 s for a height field of 400 x 400 cells.
  SweepCaster(const engine::World& world, const SensorSpec& sensor, const Eigen::Isometry3d& T_BL,
              const MotionTrack& motion, std::uint64_t seed);

  const BeamPattern& pattern() const { return *pattern_; }
  std::size_t firings(std::int64_t sweep) const;
  void cast_sweep(std::int64_t number, SweepPoints& points) const;

 private:
  struct Workspace;

  void cast_channel(const FiringBlock& block, const BlockPoses& poses, int channel, bool meets_cage,
                    const ChannelFirings& firings, RayPacket& rays) const;
  void cast_block(Workspace& work) const;
  void append(const Workspace& work, SweepPoints& points) const;

  std::unique_ptr<BeamPattern> pattern_;
  RangeErrors errors_;
  BeamSpread spread_;
  RayScene world_;
  SceneGeometry cage_geometry_;
  RayScene cage_;
  CageMask cage_mask_;
  Eigen::Isometry3d T_BL_;
  float reach_m_;
  MotionTrack motion_;
};

}  // namespace tumble::sim
