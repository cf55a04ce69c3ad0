// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/world_mesh.hpp"

#include <Eigen/Geometry>
#include <utility>

#include "sim/engine/model.hpp"
#include "sim/lidar/scene_geometry.hpp"
#include "sim/render/tessellation.hpp"

namespace tumble::sim {

namespace {

constexpr double kUnbounded_m = 60.0;
constexpr int kGroupsSeen = 3;  ///< 0, 1 and 2

std::array<float, 4> colour_of(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const float* rgba = material >= 0 ? model.mat_rgba + 4 * material : model.geom_rgba + 4 * geom;
  return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

MeshPart as_field(const Tessellation& plane, MeshPart part) {
  const auto& corners = plane.vertices_F_m;  // anticlockwise around the plane
  part.vertices_m = {corners[0], corners[1], corners[3], corners[2]};
  part.rows = part.columns = 2;
  return part;
}

MeshPart part_of(const mjModel& model, int geom, const Eigen::Isometry3d& T_FS, int segments) {
  SceneGeometry scene;
  append_geom(model, geom, T_FS, 0, HeightFieldSides::open, scene);
  MeshPart part;
  part.rgba = colour_of(model, geom);
  for (const SceneShape& shape : scene.shapes) {
    Tessellation round = tessellate(shape.shape, segments, kUnbounded_m);
    if (shape.shape.kind == ShapeKind::plane) return as_field(round, std::move(part));
    part.vertices_m = std::move(round.vertices_F_m);
    part.triangles = std::move(round.triangles);
  }
  for (SceneMesh& mesh : scene.meshes) {
    part.vertices_m = std::move(mesh.mesh.vertices_F_m);
    if (model.geom_type[geom] == mjGEOM_HFIELD) {
      part.rows = model.hfield_nrow[model.geom_dataid[geom]];
      part.columns = model.hfield_ncol[model.geom_dataid[geom]];
    } else {
      part.triangles = std::move(mesh.mesh.triangles);
    }
  }
  return part;
}

std::vector<MeshPart> body_mesh(const mjModel& model, const mjData& data, int body, const Eigen::Isometry3d& T_FW,
                                int segments) {
  std::vector<MeshPart> parts;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.geom_bodyid[geom] != body || model.geom_group[geom] >= kGroupsSeen) continue;
    if (colour_of(model, geom)[3] == 0.0f) continue;
    const bool thin = model.geom_type[geom] == mjGEOM_CAPSULE;
    parts.push_back(part_of(model, geom, T_FW * geom_pose(data, geom), thin ? (segments + 2) / 4 * 2 : segments));
  }
  return parts;
}

engine::DataPtr resting(const mjModel& model) {
  engine::DataPtr data(mj_makeData(&model));
  mj_kinematics(&model, data.get());
  return data;
}

}  // namespace

std::vector<MeshPart> world_mesh(const BuiltSituation& built, int segments) {
  const mjModel& model = *built.world().model;
  return body_mesh(model, *resting(model), 0, Eigen::Isometry3d::Identity(), segments);
}

std::vector<MeshPart> robot_mesh(const BuiltSituation& built, int segments) {
  const int body = built.world().robot_body;
  if (body < 0) return {};
  const mjModel& model = *built.world().model;
  const engine::DataPtr data = resting(model);
  Eigen::Isometry3d T_WB = Eigen::Isometry3d::Identity();
  T_WB.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat + 9 * body);
  T_WB.translation() = Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * body);
  return body_mesh(model, *data, body, T_WB.inverse(), segments);
}

}  // namespace tumble::sim
