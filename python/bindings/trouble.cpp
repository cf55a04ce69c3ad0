// SPDX-License-Identifier: BSD-3-Clause
#include "trouble.hpp"

#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <string_view>
#include <utility>

namespace tumble::python {

namespace {

nb::object error_class() {
  return nb::module_::import_("tumble.errors").attr("TumbleError");
}

/// Raises TumbleError from a message of InvalidParams: "FIELD is VALUE; it must be BOUND".
void set_invalid(const std::string& message) {
  constexpr std::string_view kMust = "; it must be ";
  const std::size_t is = message.find(" is "), must = message.find(kMust);
  nb::object field = nb::none(), value = nb::none(), bound = nb::none();
  if (is != std::string::npos && must != std::string::npos && is < must) {
    field = nb::str(message.substr(0, is).c_str());
    value = nb::float_(nb::str(message.substr(is + 4, must - is - 4).c_str()));
    bound = nb::str(message.substr(must + kMust.size()).c_str());
  }
  const nb::object type = error_class();
  const nb::object error = type(message.c_str(), "out_of_range", field, value, bound);
  PyErr_SetObject(type.ptr(), error.ptr());
}

/// Returns the Python text str(value). For an integer with thousands of digits, which Python refuses to convert,
/// returns the type.
std::string text_of(nb::handle value) {
  try {
    return nb::str(value).c_str();
  } catch (const nb::python_error&) {
    return std::string("a value of ") + nb::str(value.type()).c_str();
  }
}

/// Returns `exact` if it rounds to `time_ns`. Otherwise returns `time_ns` as an integer, or as a float if it exceeds 64
/// bits.
nb::object time_object(double time_ns, std::optional<TimeNs> exact) {
  if (exact && static_cast<double>(*exact) == time_ns) return nb::int_(*exact);
  constexpr double kLargest_ns = 9.2e18;
  if (!(std::abs(time_ns) < kLargest_ns)) return nb::float_(time_ns);
  return nb::int_(static_cast<TimeNs>(std::llround(time_ns)));
}

}  // namespace

void raise_input(const char* error_code, const std::string& field, nb::handle value, nb::handle bound) {
  const std::string text = field + " is " + text_of(value) + "; it must be " + text_of(bound);
  const nb::object type = error_class();
  const nb::object error = type(text.c_str(), error_code, field.c_str(), value, bound);
  PyErr_SetObject(type.ptr(), error.ptr());
  throw nb::python_error();
}

void require(const Status& status, std::optional<std::size_t> index, nb::object so_far, const ExactTimes& times) {
  if (status.ok()) return;
  std::string message = status.message();
  nb::object value = nb::float_(status.value), bound = nb::float_(status.bound);
  if (std::string_view(status.field).ends_with("_ns")) {
    value = time_object(status.value, times.value);
    bound = time_object(status.bound, times.bound);
    // The rounded bound may be below the rejected time; the message then would show a valid time.
    if (status.error_code == ErrorCode::time_order && PyObject_RichCompareBool(bound.ptr(), value.ptr(), Py_LT) == 1)
      bound = value;
    message = std::string(to_string(status.error_code)) + ": " + status.field + " is " + text_of(value) +
              "; the bound is " + text_of(bound);
  }
  nb::object at = nb::none();
  if (index) {
    message += " (sample " + std::to_string(*index) + ")";
    at = nb::int_(*index);
  }
  const nb::object type = error_class();
  const nb::object error =
      type(message.c_str(), to_string(status.error_code), status.field, value, bound, at, std::move(so_far));
  PyErr_SetObject(type.ptr(), error.ptr());
  throw nb::python_error();
}

void require(const Status& status, std::span<const ImuSample> samples) {
  const auto matches = [&status](const Status& found) {
    return found.error_code == status.error_code && std::strcmp(found.field, status.field) == 0;
  };
  for (std::size_t k = 0; !status.ok() && k < samples.size(); ++k) {
    const double gap_max_s =
        status.error_code == ErrorCode::gap ? status.bound : std::numeric_limits<double>::infinity();
    const bool late = k > 0 && matches(check_stamp_order(samples[k].time_ns, samples[k - 1].time_ns, gap_max_s));
    if (late) require(status, k, nb::none(), {samples[k].time_ns, samples[k - 1].time_ns});
    if (matches(check_sample(samples[k]))) require(status, k);
  }
  require(status);
}

void translate_invalid_params() {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const InvalidParams& error) {
      set_invalid(error.what());
    }
  });
}

}  // namespace tumble::python
