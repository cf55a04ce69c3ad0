// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/pcl_reader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>
#include <system_error>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

fs::path module_file() {
  const fs::path built(TUMBLE_PCL_READER);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = program.parent_path().parent_path() / "lib" / "tumble" / built.filename();
  return !error && fs::is_regular_file(beside, error) ? beside : built;
}

PclRead* load() {
  const fs::path file = module_file();
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* read = module != nullptr ? dlsym(module, kPclRead) : nullptr;
  if (read == nullptr) {
    const char* reason = dlerror();
    throw BadInput(fmt::format("the PCL library, which reads point clouds, cannot be loaded: {}",
                               (reason != nullptr ? std::string(reason) : file.string())));
  }
  return reinterpret_cast<PclRead*>(read);
}

}  // namespace

bool read_by_pcl(const fs::path& path, PclFormat format, pcl::PCLPointCloud2& cloud) {
  static PclRead* const kRead = load();
  return kRead(path.c_str(), format, &cloud);
}

}  // namespace tumble::scenarios
