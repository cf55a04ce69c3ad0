// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
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

class CdrBound {
 public:
  void operator()(std::uint8_t) { bytes += 1; }
  void operator()(std::uint32_t) { bytes += 4 + kPadding; }
  void operator()(std::uint64_t) { bytes += 8 + kPadding; }
  void operator()(float) { bytes += 4 + kPadding; }
  void operator()(const std::string& text) { bytes += 4 + kPadding + text.size() + 1; }
  template <std::size_t kCount>
  void operator()(const std::array<double, kCount>&) {
    bytes += 8 * kCount + kPadding;
  }
  void ros1_only(std::uint32_t) {}
  std::size_t count(std::size_t entries, std::size_t) {
    bytes += 4 + kPadding;
    return entries;
  }
  void raw(const std::uint8_t*, std::size_t size) { bytes += size; }
  std::size_t bytes = 4;  ///< encapsulation header

 private:
  static constexpr std::size_t kPadding = 7;
};

/// The buffer starts with zeros, because Fast-CDR does not write padding bytes.
class CdrWriter {
 public:
  explicit CdrWriter(std::size_t bound)
      : bytes_(bound),
        buffer_(reinterpret_cast<char*>(bytes_.data()), bytes_.size()),
        cdr_(buffer_, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS, eprosima::fastcdr::Cdr::DDS_CDR) {
    cdr_.serialize_encapsulation();
  }
  void operator()(std::uint8_t number) { cdr_ << number; }
  void operator()(std::uint32_t number) { cdr_ << number; }
  void operator()(std::uint64_t number) { cdr_ << number; }
  void operator()(float number) { cdr_ << number; }
  void operator()(const std::string& text) { cdr_ << text; }
  template <std::size_t kCount>
  void operator()(const std::array<double, kCount>& numbers) {
    cdr_.serializeArray(numbers.data(), kCount);
  }
  void ros1_only(std::uint32_t) {}
  std::size_t count(std::size_t entries, std::size_t) {
    cdr_ << static_cast<std::uint32_t>(entries);
    return entries;
  }
  void raw(const std::uint8_t* first, std::size_t size) { cdr_.serializeArray(first, size); }
  Bytes bytes() {
    bytes_.resize(cdr_.getSerializedDataLength());
    return std::move(bytes_);
  }

 private:
  Bytes bytes_;
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

class CdrReader {
 public:
  explicit CdrReader(Bytes& bytes)
      : size_(bytes.size()),
        buffer_(reinterpret_cast<char*>(bytes.data()), bytes.size()),
        cdr_(buffer_, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::Cdr::DDS_CDR) {
    if (size_ < 4) throw BadMessage("has " + std::to_string(size_) + " bytes; it must have at least 4");
    cdr_.read_encapsulation();
  }
  void operator()(std::uint8_t& number) { cdr_ >> number; }
  void operator()(std::uint32_t& number) { cdr_ >> number; }
  void operator()(std::uint64_t& number) { cdr_ >> number; }
  void operator()(float& number) { cdr_ >> number; }
  void operator()(std::string& text) { cdr_ >> text; }
  template <std::size_t kCount>
  void operator()(std::array<double, kCount>& numbers) {
    cdr_.deserializeArray(numbers.data(), kCount);
  }
  void ros1_only(std::uint32_t&) {}
  std::size_t count(std::size_t, std::size_t least_bytes) {
    std::uint32_t entries = 0;
    cdr_ >> entries;
    require_left(size_ - std::min(size_, cdr_.getSerializedDataLength()), entries, least_bytes);
    return entries;
  }
  void raw(std::uint8_t* out, std::size_t size) { cdr_.deserializeArray(out, size); }

 private:
  std::size_t size_;
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

}  // namespace tumble::scenarios::ros
