// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rig_calibration_file.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
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
// Early calibration files lack the key of the gyro elements and have fewer covariance rows.
constexpr const char* kElementsKey = "gyro_elements";
// Early calibration files lack the key of the gyro planes.
constexpr const char* kPlanesKey = "gyro_planes_rad_s";
// Early calibration files lack the keys of the accelerometer planes and elements.
constexpr const char* kAccelPlanesKey = "accelerometer_planes_m_s2";
constexpr const char* kAccelElementsKey = "accelerometer_elements";
// Early calibration files lack the keys of the device errors.
constexpr const char *kErrorsKey = "device_errors", *kErrorsCovarianceKey = "device_errors_covariance";
// Standard deviation of the change of an accelerometer's cross-axis sensitivity between runs, equal to the gyro's.
constexpr double kSlopeDrift = 2e-3;
// Planes with lower log-odds are not saved, because a peak of the motion can resemble a saturation plane.
constexpr double kSureLogOdds = 10.0;
// Lower bound of the standard deviation of a cross-axis sensitivity, equation (R59) of rails.md.
constexpr double kSlopeSigmaMin = 3e-4;
constexpr int kWithoutElements = RigConstants::kElements;

template <typename Array>
json numbers(const Array& values) {
  json out = json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) out.push_back(values.data()[i]);
  return out;
}

json pairs(const LearntRig::Planes& planes) {
  json out = json::array();
  for (const auto& [low, high] : planes) out.push_back({low ? json(*low) : json(), high ? json(*high) : json()});
  return out;
}

json rails(const LearntRig& rig, std::size_t first) {
  json out = json::array();
  for (std::size_t j = 0; j < 3; ++j) out.push_back(rig.rail[first + j] ? json(*rig.rail[first + j]) : json());
  return out;
}

// Reads arrays of a calibration file. Error messages state the fault and its location.
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
        complain(key, "holds an element that is not a number");
      // A number far beyond any rig constant would dominate all other numbers.
      if (std::abs(values[i].get<double>()) > kMost) {
        complain(key, fmt::format("is {}; its magnitude must be at most 1e6", values[i].dump()));
      }
      into.data()[i] = values[i].get<double>();
    }
  }

  void read_rails(const char* key, std::size_t first, LearntRig& rig) const {
    const json& values = array(key, 3);
    for (std::size_t j = 0; j < 3; ++j) {
      if (values[j].is_null()) continue;
      if (!values[j].is_number() || !(values[j].get<double>() > 0.0))
        complain(key, "holds an invalid rail; a rail must be a positive number or null");
      rig.rail[first + j] = values[j].get<double>();
    }
  }

  void read_planes(const char* key, LearntRig::Planes& planes) const {
    const json& values = array(key, 3);
    for (std::size_t j = 0; j < 3; ++j) {
      if (!values[j].is_array() || values[j].size() != 2) complain(key, "needs 3 pairs of rails");
      for (std::size_t i = 0; i < 2; ++i) {
        const json& rail = values[j][i];
        if (rail.is_null()) continue;
        const bool sound = rail.is_number() && (i == 0 ? rail.get<double>() < 0.0 : rail.get<double>() > 0.0);
        if (!sound || std::abs(rail.get<double>()) > kMost) {
          complain(key, "a pair must be null, or a negative and a positive rail of magnitude at most 1e6");
        }
        planes[j][i] = rail.get<double>();
      }
    }
  }

 private:
  const std::filesystem::path& path_;
  const json& object_;
};

std::optional<double> lowest(const LearntRig& rig, std::size_t first) {
  std::optional<double> out;
  for (std::size_t j = first; j < first + 3; ++j) {
    if (rig.rail[j] && (!out || *rig.rail[j] < *out)) out = rig.rail[j];
  }
  return out;
}

// Readings within this fraction of the saturation level count as saturated. Saturation levels are stable to 0.05 %, but
// their offset drifts with the bias.
constexpr double kToleranceShare = 2e-3;

// Returns true if the intercept of a plane is known: two standard deviations are within the tolerance of the next run.
// If two elements only clip together, the cross-axis sensitivity between the two elements is unknown. The intercept of
// the plane is then unknown too.
bool reported_level(const RailPlane& plane, int sign) {
  const Eigen::Vector4d cut(0.0, 0.0, sign, 1.0);
  const double variance = cut.dot(plane.covariance * cut), most = 0.5 * kToleranceShare * plane.distance_rad_s;
  return variance <= most * most;
}

}  // namespace

LearntRig learnt(const RateReport& report) {
  LearntRig out{report.calibration, report.rail};
  out.device_errors = report.sensor_errors;
  if (!report.clips_after_compensation) out.keep(report.planes);
  out.keep(report.accel_planes, Triad::accelerometer);
  return out;
}

void LearntRig::keep(const RailPlanes& planes, Triad triad) {
  Planes& kept = triad == Triad::gyro ? gyro_planes_rad_s : accelerometer_planes_m_s2;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::optional<RailPlane>& plane = planes.element[j];
    if (plane && plane->log_odds < kSureLogOdds) {
      // The covariance of the plane's cross-axis sensitivities is also increased.
      const double sigma = RateModelParams{}.element_sigma;
      const Eigen::Index at = RigConstants::kElements + 2 * static_cast<Eigen::Index>(j);
      if (triad == Triad::gyro) calibration.covariance.diagonal().segment<2>(at).array() += sigma * sigma;
      continue;
    }
    for (const int sign : {-1, 1}) {
      if (plane && plane->seen(sign) && reported_level(*plane, sign)) {
        kept[j][sign > 0 ? 1 : 0] = plane->offset_rad_s + sign * plane->distance_rad_s;
      }
    }
    if (!plane || triad == Triad::gyro) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      accelerometer_elements[static_cast<Eigen::Index>(2 * j + i)] =
          plane->row[static_cast<Eigen::Index>((j + 1 + i) % 3)];
    }
  }
}

namespace {

// Stores cross-axis sensitivities and intercepts of an element whose plane is certain.
void take_element(const RailPlane& plane, Triad triad, std::size_t j, LearntRig& rig) {
  const auto first = static_cast<Eigen::Index>(2 * j), at = RigConstants::kElements + first;
  const Eigen::Vector2d slopes(plane.row[static_cast<Eigen::Index>((j + 1) % 3)],
                               plane.row[static_cast<Eigen::Index>((j + 2) % 3)]);
  rig.rail[triad == Triad::gyro ? j : j + 3] = plane.distance_rad_s;
  if (triad == Triad::accelerometer) {
    rig.accelerometer_elements.segment<2>(first) = slopes;
    return;
  }
  rig.calibration.constants.elements.segment<2>(first) = slopes;
  RigConstants::Matrix& covariance = rig.calibration.covariance;
  covariance.middleRows<2>(at).setZero();
  covariance.middleCols<2>(at).setZero();
  covariance.block<2, 2>(at, at) =
      plane.covariance.topLeftCorner<2, 2>() + kSlopeSigmaMin * kSlopeSigmaMin * Eigen::Matrix2d::Identity();
}

}  // namespace

std::optional<LearntRig> with_rails(const LearntRig& before, const SaturationLevels& rails) {
  LearntRig found, out = before;
  if (!rails.upright) found.keep(rails.planes);
  if (!rails.accel_clips_after_compensation) found.keep(rails.accel_planes, Triad::accelerometer);
  out.rails_alone = true;
  bool sure = false;
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    const bool gyro = triad == Triad::gyro;
    const LearntRig::Planes& now = gyro ? found.gyro_planes_rad_s : found.accelerometer_planes_m_s2;
    LearntRig::Planes& kept = gyro ? out.gyro_planes_rad_s : out.accelerometer_planes_m_s2;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::optional<RailPlane>& plane = (gyro ? rails.planes : rails.accel_planes).element[j];
      for (std::size_t i = 0; i < 2; ++i) {
        if (now[j][i] || !plane || plane->samples[i] == 0) kept[j][i] = now[j][i];
      }
      if (!now[j][0] && !now[j][1]) continue;
      take_element(*plane, triad, j, out);
      sure = true;
    }
  }
  return sure ? std::optional(out) : std::nullopt;
}

RailPlanes LearntRig::planes(Triad triad) const {
  constexpr double kDistanceShare = 1e-3;
  const bool gyro = triad == Triad::gyro;
  const RigConstants of_accel{.elements = accelerometer_elements};
  RailPlanes out;
  for (int j = 0; j < 3; ++j) {
    const auto& [low, high] = (gyro ? gyro_planes_rad_s : accelerometer_planes_m_s2)[static_cast<std::size_t>(j)];
    if (!low && !high) continue;
    const Eigen::Index first = RigConstants::kElements + 2 * j;
    RailPlane plane;
    plane.row = (gyro ? calibration.constants : of_accel).sensing_direction(j);
    plane.distance_rad_s = low && high ? 0.5 * (*high - *low) : low ? -*low : *high;
    plane.offset_rad_s = low && high ? 0.5 * (*high + *low) : 0.0;
    const double sigma = kDistanceShare * plane.distance_rad_s;
    plane.covariance.diagonal() << 0.0, 0.0, sigma * sigma, sigma * sigma;
    plane.covariance.topLeftCorner<2, 2>() =
        gyro ? Eigen::Matrix2d(calibration.covariance.block<2, 2>(first, first))
             : Eigen::Matrix2d(kSlopeDrift * kSlopeDrift * Eigen::Matrix2d::Identity());
    plane.samples = {low ? 1 : 0, high ? 1 : 0};
    plane.log_odds = kSureLogOdds;
    plane.tolerance_rad_s = kToleranceShare * plane.distance_rad_s;
    plane.deviation_rad_s = 0.25 * plane.tolerance_rad_s;
    out.element[static_cast<std::size_t>(j)] = plane;
  }
  return out;
}

void start_from(const LearntRig& rig, double trust, RateSmoother::Params& params) {
  if (!(trust >= 1.0))
    throw std::invalid_argument(fmt::format("trust is {}, must be at least 1", std::to_string(trust)));
  params.model.calibration = rig.calibration;
  params.model.calibration->covariance *= trust;
  params.expert.planes.known = rig.planes();
  params.expert.accel_planes.known = rig.planes(Triad::accelerometer);
  for (RailPlanes* const known : {&params.expert.planes.known, &params.expert.accel_planes.known}) {
    for (std::optional<RailPlane>& plane : known->element) {
      if (plane) plane->covariance *= trust;
    }
  }
  if (rig.device_errors) {
    params.calibrated_errors = rig.device_errors;
    params.calibrated_errors->covariance *= trust;
  }
  if (const auto rail = lowest(rig, 0)) params.rails.stated_gyro_rad_s = rail;
  if (const auto rail = lowest(rig, 3)) params.rails.stated_accel_m_s2 = rail;
}

void write_learnt_rig(const std::filesystem::path& path, const LearntRig& rig) {
  const RigConstants& constants = rig.calibration.constants;
  json object;
  object["lever_arm_m"] = numbers(constants.lever_arm_m);
  object["gyro_bias_rad_s"] = numbers(constants.gyro_bias_rad_s);
  object["accel_bias_m_s2"] = numbers(constants.accel_bias_m_s2);
  object["inertia"] = numbers(constants.inertia);
  object[kElementsKey] = numbers(constants.elements);
  object["covariance"] = numbers(rig.calibration.covariance);
  object["gyro_rail_rad_s"] = rails(rig, 0);
  object["accel_rail_m_s2"] = rails(rig, 3);
  object[kPlanesKey] = pairs(rig.gyro_planes_rad_s);
  object[kAccelPlanesKey] = pairs(rig.accelerometer_planes_m_s2);
  object[kAccelElementsKey] = numbers(rig.accelerometer_elements);
  if (rig.device_errors) {
    object[kErrorsKey] = numbers(rig.device_errors->errors.vector());
    object[kErrorsCovarianceKey] = numbers(rig.device_errors->covariance);
  }
  replace_file(path, object.dump(1) + "\n");
}

namespace {

void read_device_errors(const CalibrationReader& reader, const json& object, LearntRig& rig) {
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
  // The entries of the covariance differ by orders of magnitude, so they are normalised by their standard deviations.
  const SensorErrors::Vector over = deviation.cwiseMax(1e-300).cwiseInverse();
  const SensorErrors::Matrix scaled = over.asDiagonal() * known.covariance * over.asDiagonal();
  if (!scaled.allFinite() || (scaled - scaled.transpose()).cwiseAbs().maxCoeff() > 1e-9 ||
      Eigen::LLT<SensorErrors::Matrix>(scaled).info() != Eigen::Success) {
    reader.complain(kErrorsCovarianceKey, "not symmetric and positive definite");
  }
  rig.device_errors = known;
}

}  // namespace

LearntRig read_learnt_rig(const std::filesystem::path& path) {
  std::ifstream file = open_regular_file(path);
  const json object = json::parse(file, nullptr, false);
  if (!object.is_object()) throw BadInput(path.string() + ": not a JSON object");
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
  LearntRig rig;
  reader.read("lever_arm_m", rig.calibration.constants.lever_arm_m);
  reader.read("gyro_bias_rad_s", rig.calibration.constants.gyro_bias_rad_s);
  reader.read("accel_bias_m_s2", rig.calibration.constants.accel_bias_m_s2);
  reader.read("inertia", rig.calibration.constants.inertia);
  if (object.contains(kElementsKey)) {
    reader.read(kElementsKey, rig.calibration.constants.elements);
    reader.read("covariance", rig.calibration.covariance);
  } else {
    Eigen::Matrix<double, kWithoutElements, kWithoutElements> known;
    reader.read("covariance", known);
    const double sigma = RateModelParams{}.element_sigma;
    rig.calibration.covariance = sigma * sigma * RigConstants::Matrix::Identity();
    rig.calibration.covariance.topLeftCorner<kWithoutElements, kWithoutElements>() = known;
  }
  const RigConstants::Matrix& covariance = rig.calibration.covariance;
  const double asymmetry = (covariance - covariance.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > 1e-9 * covariance.cwiseAbs().maxCoeff() ||
      Eigen::LLT<RigConstants::Matrix>(covariance).info() != Eigen::Success) {
    reader.complain("covariance", "not symmetric and positive definite");
  }
  reader.read_rails("gyro_rail_rad_s", 0, rig);
  reader.read_rails("accel_rail_m_s2", 3, rig);
  if (object.contains(kPlanesKey)) reader.read_planes(kPlanesKey, rig.gyro_planes_rad_s);
  if (object.contains(kAccelPlanesKey) != object.contains(kAccelElementsKey)) {
    reader.complain(object.contains(kAccelPlanesKey) ? kAccelElementsKey : kAccelPlanesKey, "missing");
  }
  if (object.contains(kAccelPlanesKey)) {
    reader.read_planes(kAccelPlanesKey, rig.accelerometer_planes_m_s2);
    reader.read(kAccelElementsKey, rig.accelerometer_elements);
  }
  read_device_errors(reader, object, rig);
  return rig;
}

}  // namespace tumble::scenarios
