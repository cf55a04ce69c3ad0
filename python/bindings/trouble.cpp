// SPDX-License-Identifier: BSD-3-Clause
#include "trouble.hpp"

#include <exception>
#include <utility>

namespace tumble::python {

namespace {

nb::object error_class() {
  return nb::module_::import_("tumble.errors").attr("TumbleError");
}

/// "FIELD is VALUE, must be BOUND", as InvalidParams says it.
void set_invalid(const std::string& message) {
  const std::size_t is = message.find(" is "), must = message.find(", must be ");
  nb::object field = nb::none(), value = nb::none(), bound = nb::none();
  if (is != std::string::npos && must != std::string::npos && is < must) {
    field = nb::str(message.substr(0, is).c_str());
    value = nb::float_(nb::str(message.substr(is + 4, must - is - 4).c_str()));
    bound = nb::str(message.substr(must + 10).c_str());
  }
  const nb::object type = error_class();
  const nb::object error = type(message.c_str(), "out_of_range", field, value, bound);
  PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace

void raise_input(const char* trouble, const std::string& field, nb::handle value, nb::handle bound) {
  const std::string text = field + " is " + nb::str(value).c_str() + ", must be " + nb::str(bound).c_str();
  const nb::object type = error_class();
  const nb::object error = type(text.c_str(), trouble, field.c_str(), value, bound);
  PyErr_SetObject(type.ptr(), error.ptr());
  throw nb::python_error();
}

void require(const Status& status, std::optional<std::size_t> index, nb::object so_far) {
  if (status.ok()) return;
  std::string message = status.message();
  nb::object at = nb::none();
  if (index) {
    message += " (sample " + std::to_string(*index) + ")";
    at = nb::int_(*index);
  }
  const nb::object type = error_class();
  const nb::object error =
      type(message.c_str(), to_string(status.trouble), status.field, status.value, status.bound, at, std::move(so_far));
  PyErr_SetObject(type.ptr(), error.ptr());
  throw nb::python_error();
}

nb::object doubt_of(const Status& status) {
  if (status.ok()) return nb::none();
  return error_class()(status.message().c_str(), to_string(status.trouble), status.field, status.value, status.bound);
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
