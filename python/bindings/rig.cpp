// SPDX-License-Identifier: BSD-3-Clause
#include "rig.hpp"

#include <nanobind/ndarray.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "arrays.hpp"
#include "trouble.hpp"

namespace tumble::python {

namespace {

/// Reads calibration constants in the order of BodyImuConstants, and their covariance.
BodyImuCalibration rig_from(nb::handle constants, nb::handle covariance) {
  constexpr int kSize = BodyImuConstants::kSize;
  const std::vector<double> vector = numbers_of(constants, "constants", kSize);
  const nb::object rows = as_array(covariance, "covariance").attr("reshape")(-1);
  const std::vector<double> flat = numbers_of(rows, "covariance", static_cast<std::size_t>(kSize) * kSize);
  for (const double each : vector) {
    if (!std::isfinite(each)) raise_input("non_finite", "constants", nb::float_(each), nb::str("finite"));
  }
  BodyImuCalibration out;
  out.constants.add(Eigen::Map<const BodyImuConstants::Vector>(vector.data()));
  out.covariance =
      Eigen::Map<const BodyImuConstants::Matrix>(flat.data()).transpose();  // numpy stores rows, Eigen stores columns
  const bool symmetric = (out.covariance - out.covariance.transpose()).cwiseAbs().maxCoeff() <=
                         1e-9 * out.covariance.cwiseAbs().maxCoeff();
  if (!symmetric || Eigen::LLT<BodyImuConstants::Matrix>(out.covariance).info() != Eigen::Success) {
    raise_input("out_of_range", "covariance", nb::str("not a covariance"), nb::str("symmetric and positive definite"));
  }
  return out;
}

}  // namespace

BodyImuCalibration rig_of(nb::handle given, const char* field) {
  BodyImuCalibration out;
  if (!nb::try_cast(given, out)) raise_input("type", field, given.type(), nb::str("a BodyImuCalibration"));
  return out;
}

void bind_rig(nb::module_& m) {
  using R = BodyImuCalibration;
  nb::class_<R>(m, "BodyImuCalibration",
                "Calibration of the rig estimated by one run, which another run can start from.")
      .def(
          "__init__",
          [](R* self, const ArrayLike& constants, const ArrayLike& covariance) {
            new (self) R(rig_from(constants, covariance));
          },
          nb::arg("constants"), nb::arg("covariance"),
          "constants: (20,), covariance: (20, 20), in the order of the properties with these names")
      .def_prop_ro(
          "constants",
          [](const R& r) {
            const BodyImuConstants::Vector v = r.constants.vector();
            return owned(std::vector<double>(v.data(), v.data() + v.size()));
          },
          nb::rv_policy::automatic, "(20,): lever arm, gyro bias, accelerometer bias, inertia (5), elements (6)")
      .def_prop_ro(
          "covariance", [](const R& r) { return whole<20, 20>(r.covariance.data()); }, "(20, 20)")
      .def_prop_ro(
          "lever_arm_m", [](const R& r) { return whole<3>(r.constants.lever_arm_m.data()); },
          "(3,): from the centre of mass to the IMU, IMU axes")
      .def_prop_ro("gyro_bias_rad_s", [](const R& r) { return whole<3>(r.constants.gyro_bias_rad_s.data()); })
      .def_prop_ro("accel_bias_m_s2", [](const R& r) { return whole<3>(r.constants.accel_bias_m_s2.data()); })
      .def(
          "__reduce__",
          [](nb::handle_t<R> self) {
            return nb::make_tuple(self.type(), nb::make_tuple(self.attr("constants"), self.attr("covariance")));
          },
          nb::sig("def __reduce__(self) -> tuple[object, ...]"));
}

}  // namespace tumble::python
