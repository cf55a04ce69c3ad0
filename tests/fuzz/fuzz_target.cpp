// SPDX-License-Identifier: BSD-3-Clause
// Runs one reader (TUMBLE_FUZZ_READER) under libFuzzer: fuzz_NAME [-max_total_time=S] [CORPUS] SEEDS. The reader may
// reject any file. A crash, a leak, a hang or too much memory is a defect.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/readers.hpp"

namespace {

/// A folder of this process, which is deleted at its end.
class Place {
 public:
  Place()
      : folder_(std::filesystem::temp_directory_path() /
                ("tumble_fuzz_" TUMBLE_FUZZ_READER "_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Place() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Place place;
  static const tumble::fuzz::Reader* const reader = tumble::fuzz::find_reader(TUMBLE_FUZZ_READER);
  if (reader == nullptr) std::abort();
  tumble::fuzz::takes(*reader, {reinterpret_cast<const char*>(data), size}, place.folder());
  return 0;
}
