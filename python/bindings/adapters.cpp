// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "tumble_ros/rolling_adapter.hpp"
#include "tumble_ros/tumbling_adapter.hpp"

/// Binds the adapters of the ROS 2 package, for the node in tumble/ros.py.
namespace tumble::python {

namespace {

using Numbers = std::vector<double>;

template <class Matrix>
Numbers flat(const Matrix& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

/// Returns the bytes of the records, whose members are all floats, in the layout of PointCloud2.
template <class Record>
nb::bytes bytes_of(const std::vector<Record>& records) {
  return nb::bytes(records.data(), records.size() * sizeof(Record));
}
static_assert(sizeof(ros::DeskewedPoint) == 16 && sizeof(MapPoint) == 28);

/// PublisherLike is a Python object with the methods of ros::Publisher.
class PublisherLike : public nb::object {
  NB_OBJECT_DEFAULT(PublisherLike, nb::object, "typing.Any", is_any_object)
};
using NumbersByName = nb::typed<nb::dict, nb::str, nb::object>;

/// PythonPublisher passes results to a Python object with the methods of ros::Publisher.
class PythonPublisher : public ros::Publisher {
 public:
  explicit PythonPublisher(nb::object to) : to_(std::move(to)) {}

  bool wants(ros::Output output) override {
    constexpr const char* kNames[] = {"odometry_imu", "points", "map"};
    return nb::cast<bool>(to_.attr("wants")(kNames[static_cast<int>(output)]));
  }
  void odometry(const ros::Odometry& odometry) override { to_.attr("odometry")(odometry); }
  void odometry_imu(const ros::Odometry& odometry) override { to_.attr("odometry_imu")(odometry); }
  void position_pose(const ros::Odometry& odometry) override { to_.attr("position_pose")(odometry); }
  void imu(const ros::RecoveredImu& imu) override { to_.attr("imu")(imu); }
  void points(const ros::DeskewedSweep& sweep) override { to_.attr("points")(sweep.stamp_ns, bytes_of(sweep.points)); }
  void map(TimeNs stamp_ns, const std::vector<MapPoint>& map) override { to_.attr("map")(stamp_ns, bytes_of(map)); }
  void diagnostics(TimeNs stamp_ns, const ros::Diagnostics& now) override {
    to_.attr("diagnostics")(stamp_ns, now.ok, now.message, now.values);
  }

 private:
  nb::object to_;
};

/// Bound holds an adapter and the publisher that receives its results.
template <class Adapter>
struct Bound {
  Bound(nb::object to, const typename Adapter::Params& params) : publisher(std::move(to)), adapter(params, publisher) {}
  Bound(const Bound&) = delete;
  Bound& operator=(const Bound&) = delete;
  PythonPublisher publisher;
  Adapter adapter;
};

template <class Params>
std::vector<const char*> derived() {
  const auto all = Params::computed_parameter_names();
  return {all.begin(), all.end()};
}

/// Copies the numeric parameters of a ROS node from `numbers` to `params`.
template <class Params>
void read_numbers(const nb::dict& numbers, Params& params) {
  const nb::kwargs given = nb::borrow<nb::kwargs>(numbers);
  Keywords keywords("node", given);
  read_fields(keywords, params, derived<Params>());
  keywords.done();
}

ros::TumblingAdapterParams tumbling_defaults(const std::string& imu_sheet, const std::string& lidar_sheet) {
  ros::TumblingAdapterParams params;
  params.odometry.imu = ros::imu_sheet(imu_sheet);
  params.odometry.lidar = ros::lidar_sheet(lidar_sheet);
  return params;
}

std::string message_of(const Status& status) {
  return status.ok() ? std::string() : status.message();
}

ImuSample sample_of(TimeNs stamp_ns, double wx, double wy, double wz, double fx, double fy, double fz) {
  return {stamp_ns, {wx, wy, wz}, {fx, fy, fz}, 0};
}

using FieldTuple = std::tuple<std::string, std::uint32_t, std::uint8_t, std::uint32_t>;
using Data = nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

std::string on_cloud(Bound<ros::TumblingAdapter>& self, TimeNs stamp_ns, std::uint32_t height, std::uint32_t width,
                     const std::vector<FieldTuple>& fields, bool is_bigendian, std::uint32_t point_step,
                     std::uint32_t row_step, const Data& data) {
  std::vector<ros::PointField> named;
  for (const auto& [name, offset, datatype, count] : fields) named.push_back({name, offset, datatype, count});
  return message_of(self.adapter.on_cloud(
      {stamp_ns, height, width, named, is_bigendian, point_step, row_step, {data.data(), data.size()}}));
}

std::span<const std::uint8_t> bytes_in(const nb::bytes& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

nb::bytes to_bytes(const std::string& text) {
  return nb::bytes(text.data(), text.size());
}

std::optional<ros::StartPose> start_of(const Numbers& pose, double sigma_m, double sigma_rad) {
  if (pose.empty()) return std::nullopt;
  return ros::StartPose{ros::pose_of("pose", pose), sigma_m, sigma_rad};
}

void bind_messages(nb::module_& m) {
  nb::class_<ros::Odometry>(m, "BaseOdometry", "Contents of nav_msgs/Odometry for the base frame.")
      .def_ro("stamp_ns", &ros::Odometry::stamp_ns)
      .def_prop_ro("position", [](const ros::Odometry& s) { return flat(Eigen::Vector3d(s.T_OB.translation())); })
      .def_prop_ro(
          "orientation", [](const ros::Odometry& s) { return flat(Eigen::Quaterniond(s.T_OB.linear()).coeffs()); },
          "x y z w")
      .def_prop_ro("pose_covariance", [](const ros::Odometry& s) { return flat(s.pose_covariance); })
      .def_prop_ro("twist", [](const ros::Odometry& s) { return flat(s.twist_B); })
      .def_prop_ro("twist_covariance", [](const ros::Odometry& s) { return flat(s.twist_covariance); });
  nb::class_<ros::RecoveredImu>(m, "RecoveredImu", "Contents of sensor_msgs/Imu: rate through saturation, and force.")
      .def_prop_ro("stamp_ns", [](const ros::RecoveredImu& s) { return s.rate.time_ns; })
      .def_prop_ro("rate", [](const ros::RecoveredImu& s) { return flat(s.rate.w_WI_I_rad_s); })
      .def_prop_ro("covariance", [](const ros::RecoveredImu& s) { return flat(s.rate.covariance_rad2_s2); })
      .def_prop_ro("force", [](const ros::RecoveredImu& s) { return flat(s.specific_force_m_s2); })
      .def_ro("force_variance", &ros::RecoveredImu::force_variance_m2_s4);
  m.def(
      "node_texts",
      [] {
        std::vector<std::tuple<std::string, std::string, int, std::string, bool>> out;
        for (const ros::TextParameter& text : ros::text_parameters())
          out.emplace_back(text.name, text.value, text.count, text.meaning, text.at_start);
        return out;
      },
      "Returns a tuple for each text or list parameter of the nodes: name, default, length of the list, meaning, and\n"
      "True if the nodes read the parameter only at the start.");
}

}  // namespace

void bind_adapters(nb::module_& m) {
  bind_messages(m);
  using Tumbling = Bound<ros::TumblingAdapter>;
  nb::class_<Tumbling>(m, "TumblingAdapter", "TumblingOdometry behind the messages of a robot: see ros/README.md.")
      .def(
          "__init__",
          [](Tumbling* self, const PublisherLike& publisher, const NumbersByName& numbers, const std::string& imu_sheet,
             const std::string& lidar_sheet, const std::string& time_field, const Numbers& own_body,
             const Numbers& position_arm, const Numbers& T_base_imu, const Numbers& T_base_lidar) {
            ros::TumblingAdapterParams params = tumbling_defaults(imu_sheet, lidar_sheet);
            params.T_BI = ros::pose_of("T_base_imu", T_base_imu);
            params.T_BL = ros::pose_of("T_base_lidar", T_base_lidar);
            params.odometry.own_body_L = ros::box_of("own_body", own_body);
            params.position_arm_B_m = ros::position_of("position_arm", position_arm);
            params.time_field = time_field;
            read_numbers(numbers, params);
            new (self) Tumbling(publisher, params);
          },
          nb::arg("publisher"), nb::arg("numbers"), nb::arg("imu_sheet"), nb::arg("lidar_sheet"), nb::arg("time_field"),
          nb::arg("own_body"), nb::arg("position_arm"), nb::arg("T_base_imu"), nb::arg("T_base_lidar"))
      .def_static(
          "parameters",
          [](const std::string& imu_sheet, const std::string& lidar_sheet) {
            return list_fields(tumbling_defaults(imu_sheet, lidar_sheet), derived<ros::TumblingAdapterParams>());
          },
          nb::arg("imu_sheet") = "", nb::arg("lidar_sheet") = "")
      .def(
          "on_imu",
          [](Tumbling& self, TimeNs stamp_ns, double wx, double wy, double wz, double fx, double fy, double fz) {
            return message_of(self.adapter.on_imu(sample_of(stamp_ns, wx, wy, wz, fx, fy, fz)));
          },
          "Returns an empty text, or the error.")
      .def("on_cloud", &on_cloud, "Returns an empty text, or the error.")
      .def("finish", [](Tumbling& self) { self.adapter.finish(); })
      .def(
          "on_position",
          [](Tumbling& self, TimeNs stamp_ns, const Numbers& position, const Numbers& covariance) {
            return message_of(self.adapter.on_position(stamp_ns, Eigen::Vector3d(position.data()),
                                                       Eigen::Matrix3d(covariance.data())));
          },
          "position: x y z. covariance: nine numbers. Returns an empty text, or the error.")
      .def(
          "on_livox",
          [](Tumbling& self, const nb::bytes& cdr) { return message_of(self.adapter.on_livox(bytes_in(cdr))); },
          "Processes a serialized CustomMsg. Returns an empty text, or the error.")
      .def(
          "reset",
          [](Tumbling& self, const Numbers& pose, double sigma_m, double sigma_rad) {
            return message_of(self.adapter.reset(start_of(pose, sigma_m, sigma_rad)));
          },
          nb::arg("pose"), nb::arg("sigma_m") = 0.0, nb::arg("sigma_rad") = 0.0,
          "Starts a new run at a pose of the base; an empty list: at the origin, or anywhere in the prior map. Returns "
          "an\n"
          "empty text, or the error.")
      .def(
          "load_map",
          [](Tumbling& self, const nb::bytes& map) {
            return message_of(self.adapter.load_map(std::as_bytes(bytes_in(map))));
          },
          "Starts a new run, which localises itself in a saved map. Returns an empty text, or the error.")
      .def("calibration_yaml", [](const Tumbling& self) { return self.adapter.calibration_yaml(); })
      .def("map_file",
           [](const Tumbling& self, const std::string& path) { return to_bytes(self.adapter.map_file(path)); });
  m.def(
      "livox_frame",
      [](const nb::bytes& cdr) {
        ros::LivoxCloud cloud;
        return cloud.parse(bytes_in(cdr)).ok() ? cloud.frame_id : std::string();
      },
      "Returns the frame_id of a serialized CustomMsg.");
  using Rolling = Bound<ros::RollingAdapter>;
  nb::class_<Rolling>(m, "RollingAdapter", "RollingOdometry behind the messages of a robot: see ros/README.md.")
      .def(
          "__init__",
          [](Rolling* self, const PublisherLike& publisher, const NumbersByName& numbers, const std::string& imu_sheet,
             const std::vector<Numbers>& T_base_imus) {
            ros::RollingAdapterParams params;
            for (const Numbers& T_base_imu : T_base_imus)
              params.odometry.imus.push_back({ros::imu_sheet(imu_sheet), ros::pose_of("T_base_imu", T_base_imu)});
            read_numbers(numbers, params);
            new (self) Rolling(publisher, params);
          },
          nb::arg("publisher"), nb::arg("numbers"), nb::arg("imu_sheet"), nb::arg("T_base_imus"))
      .def_static("parameters",
                  [] { return list_fields(ros::RollingAdapterParams{}, derived<ros::RollingAdapterParams>()); })
      .def("on_imu",
           [](Rolling& self, std::size_t unit, TimeNs stamp_ns, double wx, double wy, double wz, double fx, double fy,
              double fz) { return message_of(self.adapter.on_imu(unit, sample_of(stamp_ns, wx, wy, wz, fx, fy, fz))); })
      .def(
          "reset",
          [](Rolling& self, const Numbers& pose, double, double) {
            self.adapter.reset(start_of(pose, 0.0, 0.0).value_or(ros::StartPose{}).T_OB);
            return std::string();
          },
          nb::arg("pose"), nb::arg("sigma_m") = 0.0, nb::arg("sigma_rad") = 0.0);
}

}  // namespace tumble::python
