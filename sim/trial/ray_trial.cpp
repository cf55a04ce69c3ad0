// SPDX-License-Identifier: BSD-3-Clause
#include "sim/trial/ray_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/engine/model.hpp"
#include "sim/lidar/ray_scene.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

constexpr double kRayReach_m = 1e4;
/// If the faces of two surfaces are closer than this distance (for example, the end of a wall at a door frame), a ray
/// may hit either surface.
constexpr double kCoincident_m = 1e-4;

class EngineRays {
 public:
  explicit EngineRays(const engine::World& world) : world_(world), data_(mj_makeData(world.model.get())) {
    mj_forward(world.model.get(), data_.get());
  }

  struct Hit {
    double range_m;  ///< negative without a hit
    int geom;
  };
  Hit cast(const Vector3d& origin_m, const Vector3d& direction) const {
    int geom = -1;
    const double range_m = mj_ray(world_.model.get(), data_.get(), origin_m.data(), direction.data(), nullptr, 1,
                                  world_.robot_body, &geom, nullptr);
    return {range_m, geom};
  }

  double range_to(int geom, const Vector3d& origin_m, const Vector3d& direction) const {
    const mjModel* model = world_.model.get();
    const int type = model->geom_type[geom];
    if (type == mjGEOM_HFIELD)
      return mj_rayHfield(model, data_.get(), geom, origin_m.data(), direction.data(), nullptr);
    if (type == mjGEOM_MESH) return mj_rayMesh(model, data_.get(), geom, origin_m.data(), direction.data(), nullptr);
    return mju_rayGeom(data_->geom_xpos + 3 * geom, data_->geom_xmat + 9 * geom, model->geom_size + 3 * geom,
                       origin_m.data(), direction.data(), type, nullptr);
  }

 private:
  const engine::World& world_;
  engine::DataPtr data_;
};

struct TrialRay {
  Vector3d origin_m, direction;
  EngineRays::Hit expected;
};

Vector3d as_float(const Vector3d& v) {
  return v.cast<float>().cast<double>();  // same origin for both ray casters
}

Vector3d origin_above_ground(const EngineRays& rays, double half_extent_m, Stream& stream) {
  constexpr double kAbove_m = 50.0;
  const double reach_m = 0.85 * half_extent_m;
  const double y_m = stream.uniform(-reach_m, reach_m), x_m = stream.uniform(-reach_m, reach_m);
  Vector3d origin(x_m, y_m, kAbove_m);
  const EngineRays::Hit ground = rays.cast(origin, -Vector3d::UnitZ());
  const double height_m = stream.uniform(0.2, 3.0);
  origin.z() = (ground.range_m >= 0.0 ? kAbove_m - ground.range_m : 0.0) + height_m;
  return as_float(origin);
}

Vector3d origin_near_start(const Vector3d& start_W_m, Stream& stream) {
  const double z_m = stream.uniform(0.1, 1.5), y_m = stream.uniform(-1.5, 1.5), x_m = stream.uniform(-1.5, 1.5);
  return as_float(start_W_m + Vector3d(x_m, y_m, z_m));
}

Vector3d ray_direction(Stream& stream) {
  const double z = stream.normal(), y = stream.normal(), x = stream.normal();
  return as_float(Vector3d(x, y, z).normalized());
}

void set_ray(RayPacket& packet, int lane, const Vector3d& origin_m, const Vector3d& direction) {
  packet.origin_x[lane] = static_cast<float>(origin_m.x());
  packet.origin_y[lane] = static_cast<float>(origin_m.y());
  packet.origin_z[lane] = static_cast<float>(origin_m.z());
  packet.direction_x[lane] = static_cast<float>(direction.x());
  packet.direction_y[lane] = static_cast<float>(direction.y());
  packet.direction_z[lane] = static_cast<float>(direction.z());
  packet.range[lane] = static_cast<float>(kRayReach_m);
  packet.surface_id[lane] = kNothing;
}

void note(const engine::World& world, const EngineRays& engine_rays, const TrialRay& ray, float range_m,
          std::int32_t surface_id, RayDisagreement& out) {
  ++out.rays;
  const auto& [engine_range_m, geom] = ray.expected;
  if (engine_range_m >= 0.0) ++out.hits;
  const int seen = surface_id < 0 ? -1 : world.surface_geom[static_cast<std::size_t>(surface_id)];
  const bool both = seen >= 0 && geom >= 0;
  const bool same =
      seen == geom ||
      (both && std::abs(engine_rays.range_to(seen, ray.origin_m, ray.direction) - engine_range_m) < kCoincident_m);
  if (!same)
    ++out.other_surface;
  else if (both)
    out.largest_difference_m = std::max(out.largest_difference_m, std::abs(range_m - engine_range_m));
}

}  // namespace

RayDisagreement compare_rays(const BuiltSituation& built, const RayTrialOptions& options) {
  const engine::World& world = built.world();
  const EngineRays engine_rays(world);
  const RayScene mirror(static_geometry(world, HeightFieldSides::closed));
  Stream stream(options.seed, "trial.rays");
  RayDisagreement out;
  for (int done = 0; done < options.rays; done += kLanes) {
    RayPacket packet;
    packet.count = std::min(kLanes, options.rays - done);
    std::array<TrialRay, kLanes> rays;
    for (int i = 0; i < packet.count; ++i) {
      const Vector3d origin_m = i % 2 == 0 ? origin_above_ground(engine_rays, world.half_extent_m, stream)
                                           : origin_near_start(world.start_W_m, stream);
      const Vector3d direction = ray_direction(stream);
      rays[static_cast<std::size_t>(i)] = {origin_m, direction, engine_rays.cast(origin_m, direction)};
      set_ray(packet, i, origin_m + Vector3d(0, 0, options.mirror_shift_m), direction);
    }
    mirror.cast(packet);
    for (int i = 0; i < packet.count; ++i) {
      std::int32_t surface = packet.surface_id[i];
      if (surface >= 0) surface = (surface + options.surface_shift) % static_cast<int>(world.surface_geom.size());
      note(world, engine_rays, rays[static_cast<std::size_t>(i)], packet.range[i], surface, out);
    }
  }
  return out;
}

}  // namespace tumble::sim
