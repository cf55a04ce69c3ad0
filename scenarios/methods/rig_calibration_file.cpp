// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rig_calibration_file.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

using nlohmann::json;

constexpr double kMost = 1e6;
constexpr const char* kKeys[] = {"lever_arm_m", "gyro_bias_rad_s", "accel_bias_m_s2", "inertia",
                                 "covariance",  "gyro_rail_rad_s", "accel_rail_m_s2"};
// Calibration files of early versions lack the directions of the gyro's sensing elements and their covariance.
constexpr const char* kElementsKey = "gyro_elements";
constexpr const char* kPlanesKey = "gyro_planes_rad_s";
constexpr const char* kAccelPlanesKey = "accelerometer_planes_m_s2";
constexpr const char* kAccelElementsKey = "accelerometer_elements";
constexpr const char *kErrorsKey = "device_errors", *kErrorsCovarianceKey = "device_errors_covariance";
constexpr int kWithoutElements = RigConstants::kGyroMisalignment;

template <typename Array>
json numbers(const Array& values) {
  json out = json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) out.push_back(values.data()[i]);
  return out;
}

json pairs(const CalibratedRig::Planes& planes) {
  json out = json::array();
  for (const auto& [low, high] : planes) out.push_back({low ? json(*low) : json(), high ? json(*high) : json()});
  return out;
}

json rails(const CalibratedRig& rig, std::size_t first) {
  json out = json::array();
  for (std::size_t j = 0; j < 3; ++j)
    out.push_back(rig.saturation_limits[first + j] ? json(*rig.saturation_limits[first + j]) : json());
  return out;
}

class CalibrationReader {
 public:
  CalibrationReader(const std::filesystem::path& path, const json& object) : path_(path), object_(object) {}

  [[noreturn]] void complain(const std::string& key, const std::string& what) const {
    throw BadInput(path_.string() + ": " + key + ": " + what);
  }

  const json& array(const char* key, std::size_t count) const {
    const json& values = object_.at(key);
    if (!values.is_array() || values.size() != count) complain(key, fmt::format("needs exactly {} numbers", count));
    return values;
  }

  template <typename Array>
  void read(const char* key, Array& into) const {
    const json& values = array(key, static_cast<std::size_t>(into.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!values[i].is_number() || !std::isfinite(values[i].get<double>()))
        complain(key, "an element of the array is not a number; all elements must be numbers");
      // Numbers above 1e6 cannot be rig constants, and would dominate the covariance check.
      if (std::abs(values[i].get<double>()) > kMost) {
        complain(key,
                 fmt::format("an element of the array is {}; its magnitude must be at most 1e6", values[i].dump()));
      }
      into.data()[i] = values[i].get<double>();
    }
  }

  void read_rails(const char* key, std::size_t first, CalibratedRig& rig) const {
    const json& values = array(key, 3);
    for (std::size_t j = 0; j < 3; ++j) {
      if (values[j].is_null()) continue;
      if (!values[j].is_number() || !(values[j].get<double>() > 0.0))
        complain(key, "a saturation limit is not a positive number; it must be a positive number or null");
      rig.saturation_limits[first + j] = values[j].get<double>();
    }
  }

  void read_planes(const char* key, CalibratedRig::Planes& planes) const {
    const json& values = array(key, 3);
    for (std::size_t j = 0; j < 3; ++j) {
      if (!values[j].is_array() || values[j].size() != 2)
        complain(key, "the list must contain 3 pairs of saturation limits");
      for (std::size_t i = 0; i < 2; ++i) {
        const json& rail = values[j][i];
        if (rail.is_null()) continue;
        const bool sound = rail.is_number() && (i == 0 ? rail.get<double>() < 0.0 : rail.get<double>() > 0.0);
        if (!sound || std::abs(rail.get<double>()) > kMost) {
          complain(key,
                   "a pair must contain a negative and a positive saturation limit of magnitude at most 1e6, or null "
                   "for an unknown limit");
        }
        planes[j][i] = rail.get<double>();
      }
    }
  }

 private:
  const std::filesystem::path& path_;
  const json& object_;
};

}  // namespace

void write_rig_calibration(const std::filesystem::path& path, const CalibratedRig& rig) {
  const RigConstants& constants = rig.calibration.constants;
  json object;
  object["lever_arm_m"] = numbers(constants.lever_arm_m);
  object["gyro_bias_rad_s"] = numbers(constants.gyro_bias_rad_s);
  object["accel_bias_m_s2"] = numbers(constants.accel_bias_m_s2);
  object["inertia"] = numbers(constants.inertia);
  object[kElementsKey] = numbers(constants.gyro_misalignment);
  object["covariance"] = numbers(rig.calibration.covariance);
  object["gyro_rail_rad_s"] = rails(rig, 0);
  object["accel_rail_m_s2"] = rails(rig, 3);
  object[kPlanesKey] = pairs(rig.gyro_saturation_planes_rad_s);
  object[kAccelPlanesKey] = pairs(rig.accel_saturation_planes_m_s2);
  object[kAccelElementsKey] = numbers(rig.accel_misalignment);
  if (rig.known_sensor_errors) {
    object[kErrorsKey] = numbers(rig.known_sensor_errors->errors.vector());
    object[kErrorsCovarianceKey] = numbers(rig.known_sensor_errors->covariance);
  }
  replace_file(path, object.dump(1) + "\n");
}

namespace {

void read_device_errors(const CalibrationReader& reader, const json& object, CalibratedRig& rig) {
  if (object.contains(kErrorsKey) != object.contains(kErrorsCovarianceKey)) {
    reader.complain(object.contains(kErrorsKey) ? kErrorsCovarianceKey : kErrorsKey, "missing");
  }
  if (!object.contains(kErrorsKey)) return;
  SensorErrors::Vector errors;
  KnownSensorErrors known;
  reader.read(kErrorsKey, errors);
  reader.read(kErrorsCovarianceKey, known.covariance);
  known.errors = SensorErrors::from(errors);
  const SensorErrors::Vector deviation = known.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const SensorErrors::Vector over = deviation.cwiseMax(1e-300).cwiseInverse();
  const SensorErrors::Matrix scaled = over.asDiagonal() * known.covariance * over.asDiagonal();
  if (!scaled.allFinite() || (scaled - scaled.transpose()).cwiseAbs().maxCoeff() > 1e-9 ||
      Eigen::LLT<SensorErrors::Matrix>(scaled).info() != Eigen::Success) {
    reader.complain(kErrorsCovarianceKey, "the covariance matrix must be symmetric and positive definite");
  }
  rig.known_sensor_errors = known;
}

}  // namespace

CalibratedRig read_rig_calibration(const std::filesystem::path& path) {
  std::ifstream file = open_regular_file(path);
  const json object = json::parse(file, nullptr, false);
  if (!object.is_object()) throw BadInput(fmt::format("{}: the file is not a JSON object", path.string()));
  const CalibrationReader reader(path, object);
  for (const char* key : kKeys) {
    if (!object.contains(key)) reader.complain(key, "missing");
  }
  for (const auto& [key, value] : object.items()) {
    const bool known = key == kElementsKey || key == kPlanesKey || key == kAccelPlanesKey || key == kAccelElementsKey ||
                       key == kErrorsKey || key == kErrorsCovarianceKey ||
                       std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys);
    if (!known) reader.complain(key, "unknown key");
  }
  CalibratedRig rig;
  reader.read("lever_arm_m", rig.calibration.constants.lever_arm_m);
  reader.read("gyro_bias_rad_s", rig.calibration.constants.gyro_bias_rad_s);
  reader.read("accel_bias_m_s2", rig.calibration.constants.accel_bias_m_s2);
  reader.read("inertia", rig.calibration.constants.inertia);
  if (object.contains(kElementsKey)) {
    reader.read(kElementsKey, rig.calibration.constants.gyro_misalignment);
    reader.read("covariance", rig.calibration.covariance);
  } else {
    Eigen::Matrix<double, kWithoutElements, kWithoutElements> known;
    reader.read("covariance", known);
    const double sigma = AngularRateModelParams{}.element_sigma;
    rig.calibration.covariance = sigma * sigma * RigConstants::Matrix::Identity();
    rig.calibration.covariance.topLeftCorner<kWithoutElements, kWithoutElements>() = known;
  }
  const RigConstants::Matrix& covariance = rig.calibration.covariance;
  const double asymmetry = (covariance - covariance.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > 1e-9 * covariance.cwiseAbs().maxCoeff() ||
      Eigen::LLT<RigConstants::Matrix>(covariance).info() != Eigen::Success) {
    reader.complain("covariance", "the covariance matrix must be symmetric and positive definite");
  }
  reader.read_rails("gyro_rail_rad_s", 0, rig);
  reader.read_rails("accel_rail_m_s2", 3, rig);
  if (object.contains(kPlanesKey)) reader.read_planes(kPlanesKey, rig.gyro_saturation_planes_rad_s);
  if (object.contains(kAccelPlanesKey) != object.contains(kAccelElementsKey)) {
    reader.complain(object.contains(kAccelPlanesKey) ? kAccelElementsKey : kAccelPlanesKey, "missing");
  }
  if (object.contains(kAccelPlanesKey)) {
    reader.read_planes(kAccelPlanesKey, rig.accel_saturation_planes_m_s2);
    reader.read(kAccelElementsKey, rig.accel_misalignment);
  }
  read_device_errors(reader, object, rig);
  return rig;
}

}  // namespace tumble::scenarios
