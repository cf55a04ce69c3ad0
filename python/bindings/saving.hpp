// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <span>
#include <vector>

#include "guarded.hpp"
#include "trouble.hpp"

namespace tumble::python {

/// What somebody gave as a saved state; TumbleError `type` where it is no bytes.
inline std::span<const std::byte> state_of(nb::handle given) {
  if (!nb::isinstance<nb::bytes>(given)) raise_input("type", "state", given.type(), nb::str("bytes"));
  const auto bytes = nb::borrow<nb::bytes>(given);
  return {reinterpret_cast<const std::byte*>(bytes.c_str()), bytes.size()};
}

/// save() and load(), which T has, and pickling by them. `restored(bytes)` makes a T of the parameters that the bytes
/// tell.
template <class T, class Class, class Restored>
void bind_saving(Class& bound, Restored restored) {
  using Object = Guarded<T>;
  const auto saved = [](Object& self) {
    const std::vector<std::byte> bytes = self.run([](T& inside) { return inside.save(); });
    return nb::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  bound
      .def("save", saved, nb::sig("def save(self) -> bytes"),
           "All that it knows, its parameters included, with a checksum; the same on every machine.")
      .def(
          "load",
          [](Object& self, nb::handle state) {
            const std::span<const std::byte> bytes = state_of(state);
            require(self.run_timed([&](T& inside, LastTimes& last) {
              const Status status = inside.load(bytes);
              if (status.ok()) last = {};
              return status;
            }));
          },
          nb::arg("state"), nb::sig("def load(self, state: bytes) -> None"),
          "Goes on from where save() was called, with the same bits. Bytes that are damaged, of other parameters or of "
          "another\n"
          "version of the library are TumbleError, and it stays as it was. pickle needs no object to begin with.")
      .def("__getstate__", saved, nb::sig("def __getstate__(self) -> bytes"))
      .def(
          "__setstate__", [restored](Object& self, nb::handle state) { new (&self) Object(restored(state_of(state))); },
          nb::arg("state"), nb::sig("def __setstate__(self, state: bytes) -> None"));
}

}  // namespace tumble::python
