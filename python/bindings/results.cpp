// SPDX-License-Identifier: BSD-3-Clause
#include "results.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "arrays.hpp"
#include "saving.hpp"
#include "trouble.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"
#include "tumble_ros/map_file.hpp"

namespace tumble::python {

namespace {

template <class Rows>
std::size_t length(const Rows& self) {
  return self.rows.size();
}

template <class Rows>
auto times(const Rows& self) {
  return column<std::int64_t>(self.rows, [](const auto& row) { return &row.time_ns; });
}

/// Binds the length and the concatenation of result rows.
template <class Rows>
nb::class_<Rows> bind_rows(nb::module_& m, const char* name, const char* doc) {
  nb::class_<Rows> bound(m, name, doc);
  bound.def("__len__", &length<Rows>)
      .def_static(
          "joined",
          [](const std::vector<const Rows*>& parts) {
            Rows out;
            for (const Rows* part : parts) {
              if (part == nullptr) raise_input("type", "parts", nb::none(), nb::str("rows"));
              out.rows.insert(out.rows.end(), part->rows.begin(), part->rows.end());
            }
            return out;
          },
          nb::arg("parts"), "Returns the concatenated rows of several objects.");
  return bound;
}

constexpr const char* kTimes = "(N,) int64, nanoseconds";
constexpr const char* kQuaternions = "(N, 4): Hamilton, x y z w as in scipy; rotates sensor or body axes to the world";
constexpr const char* kPoseCovariance =
    "(6, 6), of (position error in W [m], attitude error phi in W [rad]); entries that are not reported are zero";
constexpr const char* kPoseCovariances = "(N, 6, 6), of (position error in W [m], attitude error phi in W [rad])";

void bind_rates_of_results(nb::module_& m) {
  bind_rows<Rates>(m, "Rates", "Angular velocity of an IMU in the world, in the IMU's axes, one per sample.")
      .def_prop_ro("time_ns", &times<Rates>, kTimes)
      .def_prop_ro(
          "rate",
          [](const Rates& s) { return column<double, 3>(s.rows, [](auto& r) { return r.w_WI_I_rad_s.data(); }); },
          "(N, 3), rad/s")
      .def_prop_ro(
          "covariance",
          [](const Rates& s) {
            return column<double, 3, 3>(s.rows, [](auto& r) { return r.covariance_rad2_s2.data(); });
          },
          "(N, 3, 3), rad^2/s^2")
      .def_prop_ro(
          "clipped_axes",
          [](const Rates& s) { return column<std::uint8_t>(s.rows, [](auto& r) { return &r.clipped_axes; }); },
          "(N,) uint8, bit j set: the gyro's axis j was at its rail")
      .def_prop_ro(
          "source",
          [](const Rates& s) {
            return column<std::uint8_t>(s.rows,
                                        [](auto& r) { return reinterpret_cast<const std::uint8_t*>(&r.source); });
          },
          "(N,) uint8: 0 measured, 1 recovered in flight, 2 recovered in contact, 3 bounded only "
          "(`AngularRateSource`)");
}

void bind_attitudes_of_results(nb::module_& m) {
  bind_rows<Attitudes>(m, "Attitudes", "Attitude of an IMU in the world, one per sample.")
      .def_prop_ro("time_ns", &times<Attitudes>, kTimes)
      .def_prop_ro(
          "quaternion",
          [](const Attitudes& s) {
            return column<double, 4>(s.rows, [](auto& r) { return r.orientation_W.coeffs().data(); });
          },
          kQuaternions)
      .def_prop_ro(
          "covariance",
          [](const Attitudes& s) {
            return column<double, 3, 3>(s.rows, [](auto& r) { return r.covariance_rad2.data(); });
          },
          "(N, 3, 3), rad^2, of phi with q_true = Exp(phi) q, world axes; zero if the method reports no covariance");
}

constexpr const char* kTransformedTo =
    "Returns the same for a frame B that is rigidly attached to the frame A, for example base_link, with covariance.\n"
    "T_AB (4, 4) is the pose of B in axes of A. rate is the angular velocity of A in axes of A [rad/s], one per pose;\n"
    "without rate, the velocity is NaN.";

/// Returns angular velocities, which are NaN if the user states none.
std::vector<Eigen::Vector3d> angular_velocities_of(const ArrayLike& rate, std::size_t poses) {
  std::vector<Eigen::Vector3d> out(poses, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  if (rate.is_none()) return out;
  const std::vector<double> numbers = numbers_of(as_array(rate, "rate").attr("reshape")(-1), "rate", 3 * poses);
  for (std::size_t k = 0; k < poses; ++k) out[k] = Eigen::Vector3d::Map(&numbers[3 * k]);
  return out;
}

void bind_poses(nb::module_& m) {
  nb::class_<PoseState>(m, "Pose", "Pose and velocity of a frame in the world at one instant.")
      .def_ro("time_ns", &PoseState::time_ns)
      .def_prop_ro(
          "position", [](const PoseState& s) { return whole<3>(s.position_W_m.data()); }, "(3,), m")
      .def_prop_ro(
          "quaternion", [](const PoseState& s) { return whole<4>(s.orientation_W.coeffs().data()); }, "(4,), x y z w")
      .def_prop_ro(
          "velocity", [](const PoseState& s) { return whole<3>(s.velocity_W_m_s.data()); }, "(3,), m/s, W")
      .def_prop_ro(
          "covariance", [](const PoseState& s) { return whole<6, 6>(s.covariance.data()); }, kPoseCovariance)
      .def_prop_ro(
          "matrix",
          [](const PoseState& s) {
            Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
            pose.linear() = s.orientation_W.toRotationMatrix();
            pose.translation() = s.position_W_m;
            return matrix(pose);
          },
          "(4, 4), transforms coordinates of the frame to W")
      .def(
          "transformed_to",
          [](const PoseState& s, const ArrayLike& T_AB, const ArrayLike& rate) {
            return s.transformed_to(pose_of(T_AB, "T_AB"), angular_velocities_of(rate, 1).front());
          },
          nb::arg("T_AB"), nb::arg("rate") = nb::none(), kTransformedTo);
  bind_rows<Poses>(m, "Poses", "Poses and velocities of a frame in the world, in order of time.")
      .def_prop_ro("time_ns", &times<Poses>, kTimes)
      .def_prop_ro(
          "position",
          [](const Poses& s) { return column<double, 3>(s.rows, [](auto& r) { return r.position_W_m.data(); }); },
          "(N, 3), m")
      .def_prop_ro(
          "quaternion",
          [](const Poses& s) {
            return column<double, 4>(s.rows, [](auto& r) { return r.orientation_W.coeffs().data(); });
          },
          kQuaternions)
      .def_prop_ro(
          "velocity",
          [](const Poses& s) { return column<double, 3>(s.rows, [](auto& r) { return r.velocity_W_m_s.data(); }); },
          "(N, 3), m/s, W")
      .def_prop_ro(
          "covariance",
          [](const Poses& s) { return column<double, 6, 6>(s.rows, [](auto& r) { return r.covariance.data(); }); },
          kPoseCovariances)
      .def(
          "transformed_to",
          [](const Poses& s, const ArrayLike& T_AB, const ArrayLike& rate) {
            const Eigen::Isometry3d T = pose_of(T_AB, "T_AB");
            const std::vector<Eigen::Vector3d> rates = angular_velocities_of(rate, s.rows.size());
            Poses out = s;
            for (std::size_t k = 0; k < rates.size(); ++k) out.rows[k] = s.rows[k].transformed_to(T, rates[k]);
            return out;
          },
          nb::arg("T_AB"), nb::arg("rate") = nb::none(), kTransformedTo);
}

void bind_rolling_of_results(nb::module_& m) {
  using R = RollingPoses;
  bind_rows<R>(m, "RollingPoses", "Poses of the centre of a rolling sphere, with the state of the contact.")
      .def_prop_ro("time_ns", &times<R>, kTimes)
      .def_prop_ro(
          "position",
          [](const R& s) { return column<double, 3>(s.rows, [](auto& r) { return r.sphere_centre_W_m.data(); }); },
          "(N, 3), m")
      .def_prop_ro(
          "quaternion",
          [](const R& s) { return column<double, 4>(s.rows, [](auto& r) { return r.q_WI.coeffs().data(); }); },
          kQuaternions)
      .def_prop_ro(
          "velocity",
          [](const R& s) { return column<double, 3>(s.rows, [](auto& r) { return r.sphere_velocity_W_m_s.data(); }); },
          "(N, 3), m/s, W")
      .def_prop_ro(
          "covariance",
          [](const R& s) { return column<double, 6, 6>(s.rows, [](auto& r) { return r.covariance.data(); }); },
          kPoseCovariances)
      .def_prop_ro(
          "velocity_covariance",
          [](const R& s) {
            return column<double, 3, 3>(s.rows, [](auto& r) { return r.velocity_covariance_I_m2_s2.data(); });
          },
          "(N, 3, 3), m^2/s^2: of the error of the velocity, in sphere axes")
      .def_prop_ro(
          "contact_mode",
          [](const R& s) {
            return column<std::uint8_t>(s.rows, [](auto& r) { return reinterpret_cast<const std::uint8_t*>(&r.mode); });
          },
          "(N,) uint8: 0 grip, 1 slip, 2 bump_or_flight, 3 incline, 4 rough (`ContactMode`)")
      .def_prop_ro(
          "at_rest", [](const R& s) { return column<bool>(s.rows, [](auto& r) { return &r.at_rest; }); }, "(N,) bool")
      .def_prop_ro(
          "position_uncertain",
          [](const R& s) { return column<bool>(s.rows, [](auto& r) { return &r.position_uncertain; }); },
          "(N,) bool: True for samples in an event that made the position uncertain");
}

void bind_map(nb::module_& m) {
  using M = MapPoints;
  bind_rows<M>(m, "MapPoints", "Points of a map, in the world.")
      .def_prop_ro(
          "position",
          [](const M& s) { return column<float, 3>(s.rows, [](auto& r) { return r.position_W_m.data(); }); },
          "(N, 3) float32, m")
      .def_prop_ro(
          "normal", [](const M& s) { return column<float, 3>(s.rows, [](auto& r) { return r.normal_W.data(); }); },
          "(N, 3) float32, unit; zero where no plane could be fitted")
      .def_prop_ro(
          "sigma", [](const M& s) { return column<float>(s.rows, [](auto& r) { return &r.sigma_m; }); },
          "(N,) float32, m: uncertainty of the position, one standard deviation")
      .def(
          "save",
          [](const M& s) {
            const std::vector<std::byte> bytes = save_map(s.rows);
            return nb::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          },
          nb::sig("def save(self) -> bytes"), "Returns the map as bytes with a checksum, for load() in a later run.")
      .def_static(
          "load",
          [](nb::handle state) {
            M out;
            require(ros::read_map(state_of(state), out.rows));
            return out;
          },
          nb::arg("state"), nb::sig("def load(state: bytes) -> MapPoints"),
          "Returns the map that save() stored, or the map in the contents of a PLY or PCD file (ASCII, or binary "
          "without "
          "compression). Raises TumbleError if the bytes are damaged or of another kind.")
      .def_static(
          "from_positions",
          [](const ArrayLike& position) {
            const nb::object rows = as_array(position, "position");
            const auto count = nb::len(rows);
            const std::vector<double> numbers = numbers_of(rows.attr("reshape")(-1), "position", 3 * count);
            std::vector<Eigen::Vector3f> positions(count);
            for (std::size_t k = 0; k < count; ++k)
              positions[k] = Eigen::Vector3d(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]).cast<float>();
            return M{to_map_points(positions)};
          },
          nb::arg("position"), "Returns map points with fitted normals for positions (N, 3) [m].");
}

void bind_findings(nb::module_& m) {
  nb::class_<HealthFinding>(m, "HealthFinding",
                            "A suspected fault of a sensor or of the estimate. str() gives a sentence.")
      .def_prop_ro(
          "kind", [](const HealthFinding& self) { return to_string(self.kind); },
          "kind of fault, for example 'frozen_axis'")
      .def_ro("sensor", &HealthFinding::sensor,
              "'imu', 'imu_2' for the second of several IMUs, 'lidar'; '': the estimate")
      .def_ro("axis", &HealthFinding::axis, "'gyro_x' to 'accel_z' if one axis is suspect, otherwise ''")
      .def_ro("quantity", &HealthFinding::quantity, "the tested quantity, with its unit")
      .def_ro("value", &HealthFinding::value, "value of the quantity")
      .def_ro("bound", &HealthFinding::bound, "violated limit")
      .def_prop_ro("severity", &HealthFinding::severity,
                   "from 0 (value at the bound) to 1 (value far beyond); a margin, not a probability")
      .def_ro("since_ns", &HealthFinding::since_ns, "start of the fault, or None if unknown")
      .def_prop_ro("invalidates_estimate", &HealthFinding::invalidates_estimate,
                   "True if the estimate should not be used")
      .def_prop_ro(
          "text", [](const HealthFinding& self) { return to_text(self); }, "one sentence for people")
      .def("__str__", [](const HealthFinding& self) { return to_text(self); })
      .def("__repr__", [](const HealthFinding& self) { return "HealthFinding: " + to_text(self); });
}

}  // namespace

Poses joined(const std::vector<std::vector<PoseState>>& parts) {
  Poses out;
  for (const std::vector<PoseState>& part : parts) out.rows.insert(out.rows.end(), part.begin(), part.end());
  return out;
}

void bind_results(nb::module_& m) {
  bind_findings(m);
  bind_rates_of_results(m);
  bind_attitudes_of_results(m);
  bind_poses(m);
  bind_rolling_of_results(m);
  bind_map(m);
}

}  // namespace tumble::python
