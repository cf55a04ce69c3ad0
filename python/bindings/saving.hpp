// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <span>
#include <vector>

#include "guarded.hpp"
#include "trouble.hpp"

namespace tumble::python {

/// Returns the bytes of a saved state. Raises TumbleError `type` if `given` is not of type bytes.
inline std::span<const std::byte> state_of(nb::handle given) {
  if (!nb::isinstance<nb::bytes>(given)) raise_input("type", "state", given.type(), nb::str("bytes"));
  const auto bytes = nb::borrow<nb::bytes>(given);
  return {reinterpret_cast<const std::byte*>(bytes.c_str()), bytes.size()};
}

/// Binds save(), load() and pickling for a class T that has save and load. `restored(bytes)` constructs a T with the
/// parameters stored in the bytes.
template <class T, class Class, class Restored>
void bind_saving(Class& bound, Restored restored) {
  using Object = Guarded<T>;
  const auto saved = [](Object& self) {
    const std::vector<std::byte> bytes = self.run([](T& inside) { return inside.save(); });
    return nb::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  bound
      .def("save", saved, nb::sig("def save(self) -> bytes"),
           "Returns the whole state and the parameters, with a checksum. The bytes are the same on every machine.")
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
          "Restores the state that save() returned; later results are identical to the bit. Raises TumbleError if the "
          "bytes\n"
          "are damaged, or belong to other parameters or another version of the library; the state is then unchanged.\n"
          "pickle also restores the object itself.")
      .def("__getstate__", saved, nb::sig("def __getstate__(self) -> bytes"))
      .def(
          "__setstate__", [restored](Object& self, nb::handle state) { new (&self) Object(restored(state_of(state))); },
          nb::arg("state"), nb::sig("def __setstate__(self, state: bytes) -> None"));
}

}  // namespace tumble::python
