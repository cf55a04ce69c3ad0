// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/engine/model.hpp"
#include "sim/lidar/shape.hpp"

namespace tumble::sim {

/// surface id of a lidar return from the robot's own cage; all ids from 0 are indices of engine::World::surfaces
inline constexpr std::int32_t kOwnCage = -2;

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_F_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct SceneShape {
  Shape shape;
  std::int32_t surface_id;
  float reflectivity;
};
struct SceneMesh {
  TriangleMesh mesh;
  std::int32_t surface_id;
  float reflectivity;
};

struct SceneGeometry {
  std::vector<SceneShape> shapes;
  std::vector<SceneMesh> meshes;
};

/// `open` selects only the top of a height field. `closed` also selects the side walls and the base, which the ray
/// caster of MuJoCo (mj_ray) also hits.
enum class HeightFieldSides { open, closed };

/// Returns the shapes and meshes of the geoms engine::World::surface_geom in world axes. The index of a geom in
/// surface_geom is the surface id. Geoms without contacts (contype and conaffinity zero) and invisible geoms (alpha
/// zero, as in mj_ray) are omitted.
SceneGeometry static_geometry(const engine::World& world, HeightFieldSides sides);

/// Returns the shapes of the robot's own cage in lidar axes. A shape that contains the origin of the lidar frame, for
/// example the housing of the lidar, is omitted, because lidar rays pass through it.
SceneGeometry cage_geometry(const engine::World& world, const Eigen::Isometry3d& T_BL);

Eigen::Isometry3d geom_pose(const mjData& data, int geom);

void append_geom(const mjModel& model, int geom, const Eigen::Isometry3d& T_FS, std::int32_t surface_id,
                 HeightFieldSides sides, SceneGeometry& scene);

/// Returns the reflectivity of a geom: the luminance (ITU-R BT.709) of its colour times the mean colour of its texture,
/// limited to 0.05 to 0.95.
float geom_reflectivity(const mjModel& model, int geom);

}  // namespace tumble::sim
