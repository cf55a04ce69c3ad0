// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/osmesa.hpp"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace tumble::sim {

namespace {

constexpr const char* kLibrary = "libOSMesa.so.8";

[[noreturn]] void fail() {
  const char* reason = dlerror();
  throw std::runtime_error(std::string("render: the library OSMesa cannot be loaded; install it (tools/setup): ") +
                           (reason != nullptr ? reason : kLibrary));
}

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) fail();
}

OsMesa load() {
  void* library = dlopen(kLibrary, RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) fail();
  OsMesa out{};
  find(library, "OSMesaCreateContextExt", out.create_context);
  find(library, "OSMesaDestroyContext", out.destroy_context);
  find(library, "OSMesaMakeCurrent", out.make_current);
  return out;
}

}  // namespace

const OsMesa& osmesa() {
  static const OsMesa kLoaded = load();  // the next call tries again
  return kLoaded;
}

}  // namespace tumble::sim
