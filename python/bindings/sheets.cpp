// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "parameters.hpp"
#include "tumble/odometry/imu_sheet.hpp"
#include "tumble/odometry/lidar_sheet.hpp"

namespace tumble::python {

namespace {

template <class Sheet>
nb::class_<Sheet> bind_sheet(nb::module_& m, const char* name, const char* doc) {
  nb::class_<Sheet> bound(m, name, doc);
  bound
      .def(
          "__init__",
          [name](Sheet* self, const nb::kwargs& options) {
            Keywords keywords(name, options);
            Sheet sheet;
            read_fields(keywords, sheet);
            keywords.done();
            new (self) Sheet(sheet);
          },
          nb::arg("options"), takes_options())
      .def_static("parameters", [] { return list_fields(Sheet{}); })
      .def("__repr__", [name](const Sheet& sheet) {
        std::string out = std::string(name) + "(";
        const std::vector<Parameter> fields = list_fields(sheet);
        for (std::size_t k = 0; k < fields.size(); ++k) {
          out += (k > 0 ? ", " : "") + fields[k].name + "=" + nb::repr(fields[k].value).c_str();
        }
        return out + ")";
      });
  return bound;
}

}  // namespace

void bind_sheets(nb::module_& m) {
  bind_sheet<ImuSheet>(
      m, "ImuSheet",
      "Data sheet of an IMU: ImuSheet(**numbers). A range of 0 means that the sheet does not state the range.")
      .def_ro("rate_hz", &ImuSheet::rate_hz)
      .def_ro("gyro_range_rad_s", &ImuSheet::gyro_range_rad_s)
      .def_ro("accel_range_m_s2", &ImuSheet::accel_range_m_s2)
      .def_ro("gyro_noise_rad_s_sqrt_hz", &ImuSheet::gyro_noise_rad_s_sqrt_hz)
      .def_ro("accel_noise_m_s2_sqrt_hz", &ImuSheet::accel_noise_m_s2_sqrt_hz);
  bind_sheet<LidarSheet>(m, "LidarSheet", "Data sheet of a lidar. LidarSheet(**numbers).")
      .def_ro("range_min_m", &LidarSheet::range_min_m)
      .def_ro("range_max_m", &LidarSheet::range_max_m);
  m.def("mti30", &sheets::mti30, "Xsens MTi-30, fifth generation (20 g).");
  m.def("vn100", &sheets::vn100, "VectorNav VN-100.");
  m.def("phidget1044", &sheets::phidget1044, "PhidgetSpatial Precision 3/3/3 1044_0.");
  m.def("mpu6050", &sheets::mpu6050, "InvenSense MPU-6050 at 500 deg/s and 16 g.");
  m.def("rs16", &sheets::rs16, "RoboSense RS-16.");
  m.def("mid40", &sheets::mid40, "Livox Mid-40.");
  m.def("mid100", &sheets::mid100, "Livox Mid-100.");
}

}  // namespace tumble::python
