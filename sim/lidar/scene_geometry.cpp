// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/scene_geometry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

namespace tumble::sim {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

bool is_seen(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const float alpha = material >= 0 ? model.mat_rgba[4 * material + 3] : model.geom_rgba[4 * geom + 3];
  return (model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0) && alpha != 0.0f;
}

class HeightField {
 public:
  HeightField(const mjModel& model, int geom)
      : id_(model.geom_dataid[geom]),
        rows_(model.hfield_nrow[id_]),
        columns_(model.hfield_ncol[id_]),
        size_(model.hfield_size + 4 * id_),
        data_(model.hfield_data + model.hfield_adr[id_]) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  double base_depth_m() const { return size_[3]; }
  Vector3d node(int row, int column) const {
    return {2.0 * size_[0] / (columns_ - 1) * column - size_[0], 2.0 * size_[1] / (rows_ - 1) * row - size_[1],
            data_[row * columns_ + column] * size_[2]};
  }

 private:
  int id_, rows_, columns_;
  const mjtNum* size_;
  const float* data_;
};

/// As in MuJoCo, each cell of the height field consists of two triangles, cut along the diagonal from (row, column) to
/// (row + 1, column + 1).
TriangleMesh height_field_top(const HeightField& field, const Isometry3d& T_FS) {
  TriangleMesh mesh;
  mesh.vertices_F_m.reserve(static_cast<std::size_t>(field.rows()) * field.columns());
  for (int row = 0; row < field.rows(); ++row) {
    for (int column = 0; column < field.columns(); ++column) {
      mesh.vertices_F_m.push_back((T_FS * field.node(row, column)).cast<float>());
    }
  }
  mesh.triangles.reserve(2 * static_cast<std::size_t>(field.rows() - 1) * (field.columns() - 1));
  for (int row = 0; row + 1 < field.rows(); ++row) {
    for (int column = 0; column + 1 < field.columns(); ++column) {
      const std::uint32_t here = static_cast<std::uint32_t>(row * field.columns() + column);
      const std::uint32_t up = here + static_cast<std::uint32_t>(field.columns());
      mesh.triangles.push_back({here, here + 1, up + 1});
      mesh.triangles.push_back({here, up + 1, up});
    }
  }
  return mesh;
}

void append_wall(const HeightField& field, const Isometry3d& T_FS, int row, int column, int row_step, int column_step,
                 TriangleMesh& mesh) {
  const int count = row_step != 0 ? field.rows() : field.columns();
  for (int i = 0; i < count; ++i) {
    const Vector3d top = field.node(row + i * row_step, column + i * column_step);
    const auto first = static_cast<std::uint32_t>(mesh.vertices_F_m.size());
    mesh.vertices_F_m.push_back((T_FS * top).cast<float>());
    mesh.vertices_F_m.push_back((T_FS * Vector3d(top.x(), top.y(), 0.0)).cast<float>());
    if (i + 1 == count) break;
    mesh.triangles.push_back({first, first + 1, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 2});
  }
}

TriangleMesh height_field_mesh(const mjModel& model, int geom, const Isometry3d& T_FS, HeightFieldSides sides) {
  const HeightField field(model, geom);
  TriangleMesh mesh = height_field_top(field, T_FS);
  if (sides == HeightFieldSides::closed) {
    append_wall(field, T_FS, 0, 0, 0, 1, mesh);
    append_wall(field, T_FS, field.rows() - 1, 0, 0, 1, mesh);
    append_wall(field, T_FS, 0, 0, 1, 0, mesh);
    append_wall(field, T_FS, 0, field.columns() - 1, 1, 0, mesh);
  }
  return mesh;
}

Shape base_box(const mjModel& model, int geom, const Isometry3d& T_FS) {
  const HeightField field(model, geom);
  const Vector3d corner = field.node(field.rows() - 1, field.columns() - 1);
  const double half_depth = 0.5 * field.base_depth_m();
  return {ShapeKind::box, Vector3d(corner.x(), corner.y(), half_depth), T_FS.linear(),
          T_FS * Vector3d(0.0, 0.0, -half_depth)};
}

TriangleMesh geom_mesh(const mjModel& model, int geom, const Isometry3d& T_FS) {
  const int id = model.geom_dataid[geom];
  TriangleMesh mesh;
  const float* vertices = model.mesh_vert + 3 * model.mesh_vertadr[id];
  for (int i = 0; i < model.mesh_vertnum[id]; ++i) {
    mesh.vertices_F_m.push_back(
        (T_FS * Vector3d(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2])).cast<float>());
  }
  const int* faces = model.mesh_face + 3 * model.mesh_faceadr[id];
  for (int i = 0; i < model.mesh_facenum[id]; ++i) {
    mesh.triangles.push_back({static_cast<std::uint32_t>(faces[3 * i]), static_cast<std::uint32_t>(faces[3 * i + 1]),
                              static_cast<std::uint32_t>(faces[3 * i + 2])});
  }
  return mesh;
}

bool primitive_kind(int type, ShapeKind& kind) {
  switch (type) {
    case mjGEOM_PLANE:
      kind = ShapeKind::plane;
      return true;
    case mjGEOM_SPHERE:
      kind = ShapeKind::sphere;
      return true;
    case mjGEOM_CAPSULE:
      kind = ShapeKind::capsule;
      return true;
    case mjGEOM_ELLIPSOID:
      kind = ShapeKind::ellipsoid;
      return true;
    case mjGEOM_CYLINDER:
      kind = ShapeKind::cylinder;
      return true;
    case mjGEOM_BOX:
      kind = ShapeKind::box;
      return true;
    default:
      return false;
  }
}

engine::DataPtr resting_data(const mjModel& model) {
  engine::DataPtr data(mj_makeData(&model));
  mj_kinematics(&model, data.get());
  return data;
}

}  // namespace

Isometry3d geom_pose(const mjData& data, int geom) {
  Isometry3d T_WS = Isometry3d::Identity();
  T_WS.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * geom);
  T_WS.translation() = Eigen::Map<const Vector3d>(data.geom_xpos + 3 * geom);
  return T_WS;
}

void append_geom(const mjModel& model, int geom, const Isometry3d& T_FS, std::int32_t surface_id,
                 HeightFieldSides sides, SceneGeometry& scene) {
  const float reflectivity = geom_reflectivity(model, geom);
  const int type = model.geom_type[geom];
  ShapeKind kind;
  if (primitive_kind(type, kind)) {
    const Vector3d size = Eigen::Map<const Vector3d>(model.geom_size + 3 * geom);
    scene.shapes.push_back({{kind, size, T_FS.linear(), T_FS.translation()}, surface_id, reflectivity});
  } else if (type == mjGEOM_HFIELD) {
    scene.meshes.push_back({height_field_mesh(model, geom, T_FS, sides), surface_id, reflectivity});
    if (sides == HeightFieldSides::closed) {
      scene.shapes.push_back({base_box(model, geom, T_FS), surface_id, reflectivity});
    }
  } else if (type == mjGEOM_MESH) {
    scene.meshes.push_back({geom_mesh(model, geom, T_FS), surface_id, reflectivity});
  } else {
    const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
    throw InvalidSituation("lidar: geom '" + std::string(name != nullptr ? name : std::to_string(geom)) +
                           "' has a geometry type that the lidar simulation does not support: " + std::to_string(type));
  }
}

float geom_reflectivity(const mjModel& model, int geom) {
  constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};
  const int material = model.geom_matid[geom];
  const float* rgba = material >= 0 ? model.mat_rgba + 4 * material : model.geom_rgba + 4 * geom;
  double texture_mean[3] = {1.0, 1.0, 1.0};
  const int texture = material >= 0 ? model.mat_texid[material * mjNTEXROLE + mjTEXROLE_RGB] : -1;
  if (texture >= 0 && model.tex_nchannel[texture] >= 3) {
    const int channels = model.tex_nchannel[texture];
    const std::int64_t pixels = static_cast<std::int64_t>(model.tex_width[texture]) * model.tex_height[texture];
    std::int64_t sum[3] = {0, 0, 0};
    for (std::int64_t i = 0; i < pixels; ++i) {
      for (int c = 0; c < 3; ++c) sum[c] += model.tex_data[model.tex_adr[texture] + i * channels + c];
    }
    for (int c = 0; c < 3; ++c) texture_mean[c] = static_cast<double>(sum[c]) / (255.0 * static_cast<double>(pixels));
  }
  double luminance = 0.0;
  for (int c = 0; c < 3; ++c) luminance += kLuminance[c] * rgba[c] * texture_mean[c];
  return static_cast<float>(std::clamp(luminance, 0.05, 0.95));
}

SceneGeometry static_geometry(const engine::World& world, HeightFieldSides sides) {
  const engine::DataPtr data = resting_data(*world.model);
  SceneGeometry scene;
  for (std::size_t id = 0; id < world.surface_geom.size(); ++id) {
    const int geom = world.surface_geom[id];
    if (!is_seen(*world.model, geom)) continue;
    append_geom(*world.model, geom, geom_pose(*data, geom), static_cast<std::int32_t>(id), sides, scene);
  }
  return scene;
}

SceneGeometry cage_geometry(const engine::World& world, const Isometry3d& T_BL) {
  SceneGeometry cage;
  if (world.robot_body < 0) return cage;
  const mjModel& model = *world.model;
  const engine::DataPtr data = resting_data(model);
  Isometry3d T_WB = Isometry3d::Identity();
  T_WB.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat + 9 * world.robot_body);
  T_WB.translation() = Eigen::Map<const Vector3d>(data->xpos + 3 * world.robot_body);
  const Isometry3d T_LW = (T_WB * T_BL).inverse();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.body_rootid[model.geom_bodyid[geom]] != model.body_rootid[world.robot_body] || !is_seen(model, geom))
      continue;
    append_geom(model, geom, T_LW * geom_pose(*data, geom), kOwnCage, HeightFieldSides::closed, cage);
  }
  std::erase_if(cage.shapes, [&](const SceneShape& s) { return contains(s.shape, Vector3d::Zero()); });
  return cage;
}

}  // namespace tumble::sim
