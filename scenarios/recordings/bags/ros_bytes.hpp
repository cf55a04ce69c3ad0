// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/bags/ros_messages.hpp"

/// Messages to and from bytes: ROS 1's plain little-endian layout, and ROS 2's CDR by Fast-CDR. Readers trust no
/// length: what a message promises is held against what is left of it before anything is allocated. Private to
/// scenarios/recordings/bags.
namespace tumble::scenarios::ros {

using Bytes = std::vector<std::uint8_t>;
static_assert(std::endian::native == std::endian::little, "ROS 1's layout is written as the numbers lie in memory");

/// A message that ends before its fields do, or promises more than it holds.
struct BadMessage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline void require_left(std::size_t left, std::size_t count, std::size_t each) {
  if (count <= left / each) return;
  throw BadMessage("promises " + std::to_string(count) + " entries of " + std::to_string(each) + " bytes, has " +
                   std::to_string(left) + " bytes left");
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
    if (size > left_) throw BadMessage("ends in the middle of a field");
    if (size > 0) std::memcpy(out, at_, size);
    at_ += size;
    left_ -= size;
  }

 private:
  const std::uint8_t* at_;
  std::size_t left_;
};

/// So many bytes at most, padding included.
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
  std::size_t bytes = 4;  ///< the encapsulation

 private:
  static constexpr std::size_t kPadding = 7;
};

/// Into bytes that are zero before: the library leaves what it pads as it finds it.
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
    if (size_ < 4) throw BadMessage("has " + std::to_string(size_) + " bytes, needs 4 at least");
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

/// The bytes of a message, and back. The readers throw BadMessage.
template <class Message>
Bytes to_ros1(Message message) {
  Ros1Writer writer;
  fields(writer, message);
  return std::move(writer.bytes);
}
template <class Message>
Bytes to_cdr(Message message) {
  CdrBound bound;
  fields(bound, message);
  CdrWriter writer(bound.bytes);
  fields(writer, message);
  return writer.bytes();
}
inline Bytes to_cdr(const Message& message) {
  return std::visit([](const auto& each) { return to_cdr(each); }, message);
}
template <class Message>
Message from_ros1(const Bytes& bytes) {
  Message message;
  Ros1Reader reader(bytes);
  fields(reader, message);
  return message;
}
template <class Message>
Message from_cdr(Bytes& bytes) {
  Message message;
  try {
    CdrReader reader(bytes);
    fields(reader, message);
  } catch (const eprosima::fastcdr::exception::Exception&) {  // "not enough memory", for want of bytes
    throw BadMessage("its " + std::to_string(bytes.size()) +
                     " bytes end before its fields do, or hold no such message");
  }
  return message;
}

}  // namespace tumble::scenarios::ros
