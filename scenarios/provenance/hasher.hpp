// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <xxhash.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>
#include <string>

namespace tumble::scenarios {

static_assert(std::endian::native == std::endian::little);

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) {
    if (!state_ || XXH3_128bits_reset(state_.get()) == XXH_ERROR) throw std::bad_alloc();
  }

  void bytes(const void* data, std::size_t size) {
    if (size > 0) XXH3_128bits_update(state_.get(), data, size);
  }
  void count(std::uint64_t number) { bytes(&number, sizeof(number)); }
  void text(const std::string& text) {
    count(text.size());
    bytes(text.data(), text.size());
  }

  std::string hex() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    char text[33];
    std::snprintf(text, sizeof(text), "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text;
  }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

}  // namespace tumble::scenarios
