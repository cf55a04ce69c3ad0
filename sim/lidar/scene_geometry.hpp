// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/engine/model.hpp"
#include "sim/lidar/shape.hpp"

/// Private to sim: what a ray can meet, taken out of a compiled model.
namespace tumble::sim {

/// Surface id of a return from the robot's own struts. Ids from 0 up index engine::World::surfaces.
inline constexpr std::int32_t kOwnCage = -2;

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_F_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Everything has a surface id and a diffuse reflectivity (0..1).
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

/// How a height field becomes triangles: its top alone, or closed by the side walls and base box that mj_ray also hits.
enum class HeightFieldSides { open, closed };

/// The geoms of engine::World::surface_geom in world axes, surface id = index there; visual-only geoms (contype and
/// conaffinity zero) and invisible ones (alpha zero, as mj_ray has it) are left out. Throws InvalidSituation on a geom
/// type that has no surface here (SDF).
SceneGeometry static_geometry(const engine::World& world, HeightFieldSides sides);

/// The robot's colliding geoms in the axes of a lidar mounted at `T_BL`, with id kOwnCage. A primitive that holds the
/// origin of L inside is the lidar's own housing or a shell around it: transparent.
SceneGeometry cage_geometry(const engine::World& world, const Eigen::Isometry3d& T_BL);

/// Pose of a geom in W where the data's kinematics have it.
Eigen::Isometry3d geom_pose(const mjData& data, int geom);

/// Adds one geom, whatever it is for, in the axes F that `T_FS` leads to from its own. Throws InvalidSituation on a
/// type that has no surface here (SDF).
void append_geom(const mjModel& model, int geom, const Eigen::Isometry3d& T_FS, std::int32_t surface_id,
                 HeightFieldSides sides, SceneGeometry& scene);

/// Diffuse reflectivity of a geom: the luminance (ITU-R BT.709) of its colour times the mean colour of its texture,
/// within 0.05..0.95. Colour stands for 905 nm here, which real surfaces do not obey.
float geom_reflectivity(const mjModel& model, int geom);

}  // namespace tumble::sim
