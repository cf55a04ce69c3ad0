// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

/// arrays.hpp converts between numpy arrays and the library's messages. Input arrays are checked for type and shape,
/// and copied into messages. Output arrays are read-only views that keep the object alive whose memory they show.
namespace tumble::python {

namespace nb = nanobind;

inline bool is_any_object(PyObject*) {
  return true;
}

/// ArrayLike is any object that numpy can convert to an array. The functions below check an ArrayLike; their errors
/// name the field.
class ArrayLike : public nb::object {
  NB_OBJECT_DEFAULT(ArrayLike, nb::object, "numpy.typing.ArrayLike", is_any_object)
};

/// WholeNumber is an integer of Python or numpy. The functions below check a WholeNumber.
class WholeNumber : public nb::object {
  NB_OBJECT_DEFAULT(WholeNumber, nb::object, "typing.SupportsIndex", is_any_object)
};

inline bool is_array(PyObject* object) {
  return nb::ndarray_check(nb::handle(object));
}

/// Doubles is an array of doubles that is returned to Python.
class Doubles : public nb::object {
  NB_OBJECT_DEFAULT(Doubles, nb::object, "numpy.typing.NDArray[numpy.float64]", is_array)
};

/// Converts one IMU sample (an int and two vectors of 3) or N samples (int64 of N and two arrays N x 3). `clip_flags`
/// contains ClipFlag bits, or is None.
/// Raises TumbleError `type` for times that are not int64, because times in seconds would lose their fractions. Raises
/// `shape` for a wrong shape. Raises `out_of_range` if the median step of at least twenty samples is below 50 us,
/// because such times are not nanoseconds.
std::vector<ImuSample> samples_of(nb::handle time_ns, nb::handle gyro_rad_s, nb::handle accel_m_s2,
                                  nb::handle clip_flags);

/// Converts the points of a sweep: N x 3 positions, N time offsets, and N rings and N intensities (each may be None).
std::vector<LidarPoint> points_of(nb::handle position_L_m, nb::handle offset_ns, nb::handle ring, nb::handle intensity);

/// Converts a time in nanoseconds from an integer of Python or numpy. Raises TumbleError `type` for other objects.
TimeNs time_of(nb::handle value, const char* field);

/// Converts a Python object to a numpy array. Raises TumbleError `type` if the conversion fails or if some values are
/// masked.
nb::object as_array(nb::handle value, const std::string& field);

/// Converts one number of Python or numpy. Raises TumbleError `type` for other objects, and for integers beyond the
/// range of a double.
double number_of(nb::handle value, const std::string& field);

/// Converts an array of `count` numbers.
std::vector<double> numbers_of(nb::handle value, const std::string& field, std::size_t count);
Eigen::Vector3d vector_of(nb::handle value, const std::string& field);

/// Converts a 4 x 4 matrix to a rigid transform. The rotation must be orthonormal to 1e-6 and the last row must be 0 0
/// 0 1; otherwise, raises TumbleError `out_of_range`.
Eigen::Isometry3d pose_of(nb::handle value, const std::string& field);
/// Converts a 2 x 3 array (lower corner, upper corner) to a box. None gives an empty box.
Eigen::AlignedBox3d box_of(nb::handle value, const std::string& field);

template <class Scalar, nb::ssize_t... Shape>
using Array = nb::ndarray<nb::numpy, const Scalar, nb::shape<Shape...>>;

/// Returns one column of `records` as an N x Rest view, without a copy. `first(record)` points to the first number of a
/// row. Matrices of Eigen are stored by columns.
template <class Scalar, nb::ssize_t... Rest, class Record, class First>
Array<Scalar, -1, Rest...> column(const std::vector<Record>& records, First first) {
  static_assert(sizeof(Record) % sizeof(Scalar) == 0);
  constexpr std::size_t kAxes = 1 + sizeof...(Rest);
  const std::size_t shape[kAxes] = {records.size(), static_cast<std::size_t>(Rest)...};
  std::int64_t strides[kAxes] = {static_cast<std::int64_t>(sizeof(Record) / sizeof(Scalar))};
  std::int64_t next = 1;
  for (std::size_t k = 1; k < kAxes; ++k) {
    strides[k] = next;
    next *= static_cast<std::int64_t>(shape[k]);
  }
  static const Record none{};
  const Scalar* const data = first(records.empty() ? none : records.front());
  return Array<Scalar, -1, Rest...>(data, kAxes, shape, nb::handle(), strides);
}

/// Returns a view of a fixed-size vector or matrix of Eigen, without a copy.
template <nb::ssize_t... Shape, class Scalar>
Array<Scalar, Shape...> whole(const Scalar* first) {
  const std::size_t shape[] = {static_cast<std::size_t>(Shape)...};
  std::int64_t strides[sizeof...(Shape)];
  std::int64_t next = 1;
  for (std::size_t k = 0; k < sizeof...(Shape); ++k) {
    strides[k] = next;
    next *= static_cast<std::int64_t>(shape[k]);
  }
  return Array<Scalar, Shape...>(first, sizeof...(Shape), shape, nb::handle(), strides);
}

/// Returns a copy of `values` that Python owns.
template <class Scalar>
nb::ndarray<nb::numpy, Scalar, nb::ndim<1>> owned(std::vector<Scalar> values) {
  auto* const kept = new std::vector<Scalar>(std::move(values));
  const nb::capsule owner(kept, [](void* at) noexcept { delete static_cast<std::vector<Scalar>*>(at); });
  const std::size_t shape[] = {kept->size()};
  return nb::ndarray<nb::numpy, Scalar, nb::ndim<1>>(kept->data(), 1, shape, owner);
}

/// Returns a copy of a rigid transform as a 4 x 4 matrix.
Doubles matrix(const Eigen::Isometry3d& pose);

}  // namespace tumble::python
