// SPDX-License-Identifier: BSD-3-Clause
#include "arrays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "trouble.hpp"

namespace tumble::python {

namespace {

template <class Scalar>
using Given = nb::ndarray<const Scalar, nb::device::cpu>;

std::string text(nb::handle value) {
  return nb::str(value).c_str();
}

/// Rejects masked arrays, because numpy would pass on the values below the mask.
void require_unmasked(nb::handle value, const std::string& field) {
  if (!nb::hasattr(value, "_mask")) return;
  if (nb::cast<bool>(nb::module_::import_("numpy.ma").attr("is_masked")(value)))
    raise_input("type", field, nb::str("masked"), nb::str("numbers without a mask"));
}

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string out = "(";
  for (std::size_t k = 0; k < shape.size(); ++k) out += (k > 0 ? ", " : "") + std::to_string(shape[k]);
  return out + (shape.size() == 1 ? ",)" : ")");
}

/// Converts `value` to an array of type `Scalar` and shape `shape`. For a float type, integers and other float types
/// are converted too.
template <class Scalar>
Given<Scalar> array_of(nb::handle value, const std::string& field, const std::vector<std::size_t>& shape) {
  constexpr bool kFloat = std::is_floating_point_v<Scalar>;
  require_unmasked(value, field);
  Given<Scalar> out;
  if (!nb::try_cast(value, out, false)) {
    const nb::object array = as_array(value, field);
    const std::string kind = text(array.attr("dtype").attr("kind"));
    const bool number = kind == "i" || kind == "u" || (kFloat && kind == "f");
    if (!number || !nb::try_cast(array, out, kFloat)) {
      const char* const bound = kFloat ? "numbers" : std::is_same_v<Scalar, std::int64_t> ? "int64 (nanoseconds)" : "";
      raise_input("type", field, array.attr("dtype"), nb::str(bound));
    }
  }
  bool fits = out.ndim() == shape.size();
  for (std::size_t k = 0; fits && k < shape.size(); ++k) fits = out.shape(k) == shape[k];
  if (!fits) {
    std::vector<std::size_t> found(out.ndim());
    for (std::size_t k = 0; k < found.size(); ++k) found[k] = out.shape(k);
    raise_input("shape", field, nb::str(shape_text(found).c_str()), nb::str(shape_text(shape).c_str()));
  }
  return out;
}

/// Converts integers of any width to `Scalar`. Raises TumbleError if an integer is negative or exceeds the range of
/// `Scalar`.
template <class Scalar>
std::vector<Scalar> counts_of(nb::handle value, const std::string& field, std::size_t count) {
  std::vector<Scalar> out(count);
  if (value.is_none()) return out;
  require_unmasked(value, field);
  Given<Scalar> same;
  if (nb::try_cast(value, same, false) && same.ndim() == 1 && same.shape(0) == count) {
    for (std::size_t k = 0; k < count; ++k) out[k] = same.data()[static_cast<std::int64_t>(k) * same.stride(0)];
    return out;
  }
  const nb::object array = as_array(value, field);
  const std::string kind = text(array.attr("dtype").attr("kind"));
  if (kind != "i" && kind != "u") raise_input("type", field, array.attr("dtype"), nb::str("whole numbers"));
  const Given<std::int64_t> wide = array_of<std::int64_t>(array.attr("astype")("int64"), field, {count});
  for (std::size_t k = 0; k < count; ++k) {
    const std::int64_t each = wide.data()[static_cast<std::int64_t>(k) * wide.stride(0)];
    if (each < 0 || each > static_cast<std::int64_t>(std::numeric_limits<Scalar>::max())) {
      raise_input("out_of_range", field, nb::int_(each),
                  nb::str(("within [0, " + std::to_string(std::numeric_limits<Scalar>::max()) + "]").c_str()));
    }
    out[k] = static_cast<Scalar>(each);
  }
  return out;
}

/// Returns row k of an N x 3 array.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> row(const Given<Scalar>& array, std::size_t k) {
  const Scalar* const at = array.data() + static_cast<std::int64_t>(k) * array.stride(0);
  return {at[0], at[array.stride(1)], at[2 * array.stride(1)]};
}

ImuSample one_sample(nb::handle time_ns, nb::handle gyro_rad_s, nb::handle accel_m_s2, nb::handle clip_flags) {
  ImuSample out;
  out.time_ns = time_of(time_ns, "time_ns");
  out.angular_velocity_rad_s = vector_of(gyro_rad_s, "gyro_rad_s");
  out.specific_force_m_s2 = vector_of(accel_m_s2, "accel_m_s2");
  if (!clip_flags.is_none()) {
    const nb::object listed = nb::module_::import_("numpy").attr("atleast_1d")(as_array(clip_flags, "clip_flags"));
    out.device_clip_flags = counts_of<std::uint8_t>(listed, "clip_flags", 1).front();
  }
  return out;
}

}  // namespace

nb::object as_array(nb::handle value, const std::string& field) {
  require_unmasked(value, field);
  try {
    return nb::module_::import_("numpy").attr("asarray")(value);
  } catch (const nb::python_error& error) {  // for example, rows of different lengths
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
  }
  raise_input("type", field, value.type(), nb::str("an array of numbers"));
}

double number_of(nb::handle value, const std::string& field) {
  if (PyNumber_Check(value.ptr()) != 0) {
    const nb::object number = nb::steal(PyNumber_Float(value.ptr()));
    double out = 0.0;
    if (number.is_valid() && nb::try_cast(number, out)) return out;
    PyErr_Clear();  // the value is complex, an array, or beyond the range of a double
  }
  raise_input("type", field, value, nb::str("a number"));
}

TimeNs time_of(nb::handle value, const char* field) {
  const bool whole_number = PyIndex_Check(value.ptr()) != 0 && !PyBool_Check(value.ptr());
  if (!whole_number) raise_input("type", field, value, nb::str("a whole number of nanoseconds"));
  const nb::object index = nb::steal(PyNumber_Index(value.ptr()));
  if (!index.is_valid()) {  // the value is an array
    PyErr_Clear();
    raise_input("type", field, value, nb::str("a whole number of nanoseconds"));
  }
  std::int64_t out = 0;
  if (!nb::try_cast(index, out, false)) raise_input("out_of_range", field, index, nb::str("within 64 bits"));
  return out;
}

/// Raises TumbleError if the times are not in nanoseconds. Every IMU has a median sample period above 50 us.
static void require_nanoseconds(const std::vector<ImuSample>& samples) {
  constexpr std::size_t kMinSamples = 20;
  constexpr std::int64_t kMinStep_ns = 50'000;
  if (samples.size() < kMinSamples) return;
  std::vector<std::int64_t> steps;
  for (std::size_t k = 1; k < samples.size(); ++k) steps.push_back(samples[k].time_ns - samples[k - 1].time_ns);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  // the estimator rejects times that do not increase, and reports the index
  if (*middle > 0 && *middle < kMinStep_ns) {
    raise_input("out_of_range", "time_ns (median step, ns)", nb::int_(*middle), nb::int_(kMinStep_ns));
  }
}

std::vector<ImuSample> samples_of(nb::handle time_ns, nb::handle gyro_rad_s, nb::handle accel_m_s2,
                                  nb::handle clip_flags) {
  if (PyLong_Check(time_ns.ptr())) return {one_sample(time_ns, gyro_rad_s, accel_m_s2, clip_flags)};
  const nb::object listed = as_array(time_ns, "time_ns");
  if (nb::cast<int>(listed.attr("ndim")) == 0) return {one_sample(time_ns, gyro_rad_s, accel_m_s2, clip_flags)};
  const std::size_t count = nb::len(listed);
  const Given<std::int64_t> times = array_of<std::int64_t>(listed, "time_ns", {count});
  const Given<double> gyro = array_of<double>(gyro_rad_s, "gyro_rad_s", {count, 3});
  const Given<double> accel = array_of<double>(accel_m_s2, "accel_m_s2", {count, 3});
  const std::vector<std::uint8_t> flags = counts_of<std::uint8_t>(clip_flags, "clip_flags", count);
  std::vector<ImuSample> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    out[k].time_ns = times.data()[static_cast<std::int64_t>(k) * times.stride(0)];
    out[k].angular_velocity_rad_s = row(gyro, k);
    out[k].specific_force_m_s2 = row(accel, k);
    out[k].device_clip_flags = flags[k];
  }
  require_nanoseconds(out);
  return out;
}

std::vector<LidarPoint> points_of(nb::handle position_L_m, nb::handle offset_ns, nb::handle ring,
                                  nb::handle intensity) {
  const nb::object listed = as_array(position_L_m, "position_L_m");
  const std::size_t count =
      nb::hasattr(listed, "__len__") && nb::cast<int>(listed.attr("ndim")) > 0 ? nb::len(listed) : 0;
  const Given<float> positions = array_of<float>(listed, "position_L_m", {count, 3});
  const std::vector<std::uint32_t> offsets = counts_of<std::uint32_t>(offset_ns, "offset_ns", count);
  const std::vector<std::uint16_t> rings = counts_of<std::uint16_t>(ring, "ring", count);
  Given<float> intensities;
  if (!intensity.is_none()) intensities = array_of<float>(intensity, "intensity", {count});
  std::vector<LidarPoint> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    out[k].position_L_m = row(positions, k);
    out[k].offset_ns = offsets[k];
    out[k].ring = rings[k];
    if (intensities.is_valid())
      out[k].intensity = intensities.data()[static_cast<std::int64_t>(k) * intensities.stride(0)];
  }
  return out;
}

std::vector<double> numbers_of(nb::handle value, const std::string& field, std::size_t count) {
  const Given<double> array = array_of<double>(value, field, {count});
  std::vector<double> out(count);
  for (std::size_t k = 0; k < count; ++k) out[k] = array.data()[static_cast<std::int64_t>(k) * array.stride(0)];
  return out;
}

Eigen::Vector3d vector_of(nb::handle value, const std::string& field) {
  const std::vector<double> numbers = numbers_of(value, field, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

Eigen::Isometry3d pose_of(nb::handle value, const std::string& field) {
  const Given<double> array = array_of<double>(value, field, {4, 4});
  Eigen::Matrix4d m;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) m(i, j) = array.data()[i * array.stride(0) + j * array.stride(1)];
  }
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  const double rotation_error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  const bool rigid =
      m.allFinite() && rotation_error < 1e-6 && R.determinant() > 0.0 && m.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  if (!rigid)
    raise_input("out_of_range", field, nb::str("not a rigid transform"), nb::str("a rotation and a translation"));
  Eigen::Isometry3d out;
  out.matrix() = m;
  return out;
}

Eigen::AlignedBox3d box_of(nb::handle value, const std::string& field) {
  if (value.is_none()) return {};
  const Given<double> array = array_of<double>(value, field, {2, 3});
  return {row(array, 0), row(array, 1)};
}

Doubles matrix(const Eigen::Isometry3d& pose) {
  const nb::object array = nb::cast(owned(std::vector<double>(pose.data(), pose.data() + 16)));
  return nb::cast<Doubles>(array.attr("reshape")(4, 4).attr("T").attr("copy")());
}

}  // namespace tumble::python
