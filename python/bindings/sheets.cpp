// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "parameters.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

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

template <class Sheet>
void bind_named(nb::module_& m, const sheets::Named<Sheet>& sheet, const char* doc) {
  m.def(
      sheet.name, [&sheet] { return sheet.data_sheet; }, doc);
}

}  // namespace

void bind_sheets(nb::module_& m) {
  bind_sheet<ImuDataSheet>(
      m, "ImuDataSheet",
      "Data sheet of an IMU: ImuDataSheet(**numbers). A range of 0 means that the sheet does not state the range.")
      .def_ro("rate_hz", &ImuDataSheet::rate_hz)
      .def_ro("gyro_range_rad_s", &ImuDataSheet::gyro_range_rad_s)
      .def_ro("accel_range_m_s2", &ImuDataSheet::accel_range_m_s2)
      .def_ro("gyro_noise_rad_s_sqrt_hz", &ImuDataSheet::gyro_noise_rad_s_sqrt_hz)
      .def_ro("accel_noise_m_s2_sqrt_hz", &ImuDataSheet::accel_noise_m_s2_sqrt_hz);
  bind_sheet<LidarDataSheet>(m, "LidarDataSheet", "Data sheet of a lidar. LidarDataSheet(**numbers).")
      .def_ro("range_min_m", &LidarDataSheet::range_min_m)
      .def_ro("range_max_m", &LidarDataSheet::range_max_m);
  bind_named(m, sheets::mti30, "Xsens MTi-30, fifth generation (20 g).");
  bind_named(m, sheets::vn100, "VectorNav VN-100.");
  bind_named(m, sheets::phidget1044, "PhidgetSpatial Precision 3/3/3 1044_0.");
  bind_named(m, sheets::mpu6050, "InvenSense MPU-6050 with ranges of 500 deg/s and 16 g.");
  bind_named(m, sheets::bmi088, "Bosch BMI088 with ranges of 2000 deg/s and 24 g.");
  bind_named(m, sheets::icm20948, "InvenSense ICM-20948 with ranges of 2000 deg/s and 16 g.");
  bind_named(m, sheets::icm42688, "InvenSense ICM-42688-P with ranges of 2000 deg/s and 16 g.");
  bind_named(m, sheets::mti3, "Xsens MTi-3.");
  bind_named(m, sheets::lsm6dso, "STMicroelectronics LSM6DSO with ranges of 2000 deg/s and 16 g.");
  bind_named(m, sheets::ouster_imu, "IMU inside an Ouster OS0 or OS1, in the default setting of 250 deg/s and 2 g.");
  bind_named(m, sheets::mid360_imu, "IMU inside a Livox Mid-360 with ranges of 2000 deg/s and 4 g.");
  bind_named(m, sheets::icm20601, "InvenSense ICM-20601 with ranges of 2000 deg/s and 32 g.");
  bind_named(m, sheets::icm20602, "InvenSense ICM-20602 with ranges of 2000 deg/s and 16 g.");
  bind_named(m, sheets::lsm6dsv320x, "STMicroelectronics LSM6DSV320X with ranges of 4000 deg/s and 16 g.");
  bind_named(m, sheets::adis16405, "Analog Devices ADIS16405 with ranges of 300 deg/s and 18 g.");
  bind_named(m, sheets::iim42653, "InvenSense IIM-42653 with ranges of 4000 deg/s and 32 g.");
  bind_named(m, sheets::rs16, "RoboSense RS-16.");
  bind_named(m, sheets::mid40, "Livox Mid-40.");
  bind_named(m, sheets::mid100, "Livox Mid-100.");
  bind_named(m, sheets::vlp16, "Velodyne VLP-16.");
  bind_named(m, sheets::xt16, "Hesai XT16.");
  bind_named(m, sheets::xt32, "Hesai XT32.");
  bind_named(m, sheets::helios32, "RoboSense Helios with 32 beams.");
  bind_named(m, sheets::os0_64, "Ouster OS0 with 64 rings.");
  bind_named(m, sheets::os0_128, "Ouster OS0 with 128 rings.");
  bind_named(m, sheets::os1_64, "Ouster OS1 with 64 rings.");
  bind_named(m, sheets::os1_128, "Ouster OS1 with 128 rings.");
  bind_named(m, sheets::mid360, "Livox Mid-360.");
}

}  // namespace tumble::python
