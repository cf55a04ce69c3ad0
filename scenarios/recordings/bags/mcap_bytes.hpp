// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/recordings/bags/mcap_records.hpp"

namespace tumble::scenarios::mcap {

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
inline constexpr std::uint64_t kHeadBytes = 9;

struct BadRecord : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Put {
 public:
  template <std::unsigned_integral Number>
  void operator()(Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  void operator()(const std::string& text) { (*this)(static_cast<std::uint32_t>(text.size())), bytes += text; }
  template <class Entries>
  requires requires(Entries entries) { entries.begin()->second; }
  void operator()(const Entries& entries) {
    Put inner;
    for (const auto& [key, value] : entries) inner(key), inner(value);
    (*this)(inner.bytes);
  }
  std::string bytes;
};

class Take {
 public:
  explicit Take(std::string_view bytes) : left(bytes) {}
  template <std::unsigned_integral Number>
  void operator()(Number& number) {
    std::memcpy(&number, cut(sizeof(number)).data(), sizeof(number));
  }
  void operator()(std::string& text) { text = block(); }
  template <class Key, class Value>
  void operator()(std::map<Key, Value>& entries) {
    for (Take inner(block()); !inner.left.empty();) {
      Key key{};
      inner(key);
      inner(entries[key]);
    }
  }
  template <class First, class Second>
  void operator()(std::vector<std::pair<First, Second>>& entries) {
    for (Take inner(block()); !inner.left.empty();) {
      auto& [first, second] = entries.emplace_back();
      inner(first), inner(second);
    }
  }
  std::string_view cut(std::uint64_t size) {
    if (size > left.size()) {
      throw BadRecord("needs " + std::to_string(size) + " bytes, but only " + std::to_string(left.size()) +
                      " are left");
    }
    const std::string_view out = left.substr(0, size);
    left.remove_prefix(size);
    return out;
  }
  std::string_view left;

 private:
  std::string_view block() {
    std::uint32_t size = 0;
    (*this)(size);
    return cut(size);
  }
};

template <class Record>
std::string to_bytes(Record record, std::string_view tail = {}) {
  Put content, out;
  fields(content, record);
  out(static_cast<std::uint8_t>(Record::op));
  out(static_cast<std::uint64_t>(content.bytes.size() + tail.size()));
  return std::move(out.bytes.append(content.bytes).append(tail));
}

template <class Record>
Record from_bytes(std::string_view content) {
  Record record;
  Take take(content);
  fields(take, record);
  return record;
}

}  // namespace tumble::scenarios::mcap
