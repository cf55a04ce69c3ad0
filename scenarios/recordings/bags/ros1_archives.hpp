// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

/// The decoder checks every length against the remaining bytes before it allocates memory.
namespace tumble::scenarios::ros {

using Bytes = std::vector<std::uint8_t>;
static_assert(std::endian::native == std::endian::little, "ROS 1 messages are written in the byte order of memory");

struct BadMessage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline void require_left(std::size_t left, std::size_t count, std::size_t each) {
  if (count <= left / each) return;
  throw BadMessage("the message states " + std::to_string(count) + " entries of " + std::to_string(each) +
                   " bytes, but only " + std::to_string(left) + " bytes are left");
}

class Ros1Writer {
 public:
  template <class Number>
  void operator()(const Number& number) {
    raw(reinterpret_cast<const std::uint8_t*>(&number), sizeof(number));
  }
  void operator()(const std::string& text) {
    count(text.size(), 1);
    raw(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  void ros1_only(std::uint32_t number) { (*this)(number); }
  std::size_t count(std::size_t entries, std::size_t) {
    (*this)(static_cast<std::uint32_t>(entries));
    return entries;
  }
  void raw(const std::uint8_t* first, std::size_t size) { bytes.insert(bytes.end(), first, first + size); }
  Bytes bytes;
};

class Ros1Reader {
 public:
  explicit Ros1Reader(const Bytes& bytes) : at_(bytes.data()), left_(bytes.size()) {}

  template <class Number>
  void operator()(Number& number) {
    raw(reinterpret_cast<std::uint8_t*>(&number), sizeof(number));
  }
  void operator()(std::string& text) {
    text.resize(count(0, 1));
    raw(reinterpret_cast<std::uint8_t*>(text.data()), text.size());
  }
  void ros1_only(std::uint32_t& number) { (*this)(number); }
  std::size_t count(std::size_t, std::size_t least_bytes) {
    std::uint32_t entries = 0;
    (*this)(entries);
    require_left(left_, entries, least_bytes);
    return entries;
  }
  void raw(std::uint8_t* out, std::size_t size) {
    if (size > left_) throw BadMessage("ends within a field");
    if (size > 0) std::memcpy(out, at_, size);
    at_ += size;
    left_ -= size;
  }

 private:
  const std::uint8_t* at_;
  std::size_t left_;
};

}  // namespace tumble::scenarios::ros
