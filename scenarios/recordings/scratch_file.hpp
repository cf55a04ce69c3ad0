// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/unfinished.hpp"

namespace tumble::scenarios {

std::filesystem::path scratch_folder_of(const std::filesystem::path& output);

/// ScratchFile is an unnamed temporary file, which exists until the object is destroyed or the process ends.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path folder);
  ~ScratchFile();
  ScratchFile(ScratchFile&& other) noexcept
      : folder_(std::move(other.folder_)),
        descriptor_(std::exchange(other.descriptor_, -1)),
        bytes_(std::exchange(other.bytes_, 0)) {}
  ScratchFile& operator=(ScratchFile&& other) noexcept {
    std::swap(folder_, other.folder_), std::swap(descriptor_, other.descriptor_), std::swap(bytes_, other.bytes_);
    return *this;
  }

  std::uint64_t bytes() const { return bytes_; }
  void append(std::span<const std::byte> bytes) { write(bytes_, bytes); }
  void write(std::uint64_t at, std::span<const std::byte> bytes);
  void read(std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0;
};

template <class Row>
class ColumnFile {
 public:
  ColumnFile() = default;
  explicit ColumnFile(const std::filesystem::path& folder) : file_(std::in_place, folder) {}

  std::size_t size() const { return file_ ? file_->bytes() / sizeof(Row) : 0; }
  void append(std::span<const Row> rows) { file_->append(std::as_bytes(rows)); }
  void read(std::size_t first, std::span<Row> rows) const {
    if (!rows.empty()) file_->read(first * sizeof(Row), std::as_writable_bytes(rows));
  }
  std::vector<Row> rows(std::size_t first, std::size_t last) const {
    std::vector<Row> out(last - first);
    read(first, out);
    return out;
  }
  template <class Take>
  void for_segments(std::size_t length, Take&& take) const {
    std::vector<Row> rows;
    for (std::size_t first = 0; first < size(); first += rows.size()) {
      rows.resize(std::min(length, size() - first));
      read(first, rows);
      take(first, std::span<const Row>(rows));
    }
  }
  template <class Change>
  void change(Change&& change) {
    constexpr std::size_t kLength = (std::size_t{1} << 20) / sizeof(Row);
    for_segments(kLength, [&](std::size_t first, std::span<const Row> rows) {
      std::vector<Row> changed(rows.begin(), rows.end());
      for (Row& row : changed) change(row);
      file_->write(first * sizeof(Row), std::as_bytes(std::span(changed)));
    });
  }

 private:
  std::optional<ScratchFile> file_;
};

/// ScratchFolder is a temporary folder, which is removed when the object is destroyed or when a signal ends the
/// program.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& use);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::optional<Unfinished> on_signal_;
};

}  // namespace tumble::scenarios
