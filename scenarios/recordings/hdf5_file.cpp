// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/hdf5_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/processes/process.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios::hdf5 {

namespace {

constexpr std::size_t kSuperblockBytes = 48;

Handle open_file(const std::filesystem::path& path) {
  require_recording_file(path);  // HDF5 reports missing permission as damage
  require_survivable(path);
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file.valid()) return file;
  const std::string reason = last_error();
  if (std::error_code error; std::filesystem::file_size(path, error) == 0)
    throw BadInput(path.string() + ": the file is empty");
  throw BadInput(fmt::format("{}: the file is truncated, damaged or not an HDF5 file{}", path.string(), reason));
}

/// Returns the length of the HDF5 data, which the superblock (version 3) stores at byte 28. The file on disk is longer
/// than the HDF5 data, because create_file() reserves disk space in advance.
std::uint64_t stated_length(const void* image) {
  std::uint64_t length = 0;
  std::memcpy(&length, static_cast<const char*>(image) + 28, sizeof(length));
  return length;
}

Handle create_file(const std::string& name, const std::filesystem::path& path, std::uint64_t most_bytes) {
  const auto require = [&](bool done) {
    if (!done) throw BadInput(fmt::format("{}: the file cannot be prepared for writing{}", name, last_error()));
  };
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  require(H5Pset_fapl_sec2(access.get()) >= 0 && H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG) >= 0 &&
          H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0);
  H5Pset_obj_track_times(creation.get(), false);  // equal recordings give equal files
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
  require(file.valid());
  void* descriptor = nullptr;
  require(H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &descriptor) >= 0);
  const int error = posix_fallocate(*static_cast<int*>(descriptor), 0, static_cast<off_t>(most_bytes));
  if (error != 0) throw BadInput(name + ": cannot be written: " + std::generic_category().message(error));
  return file;
}

Group root_of(const Handle& file, const std::string& name) {
  Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
  if (!root.valid()) throw BadInput(fmt::format("{}: the file has no root group{}", name, last_error()));
  return Group(std::move(root), name, "");
}

}  // namespace

std::string last_error() {
  std::string text;
  const H5E_walk2_t keep_first = [](unsigned level, const H5E_error2_t* error, void* out) -> herr_t {
    if (level == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &text);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "" : " (" + text + ")";
}

Handle& Handle::operator=(Handle&& other) noexcept {
  Handle moved(std::move(other));
  std::swap(id_, moved.id_);
  std::swap(close_, moved.close_);
  return *this;
}

Handle::~Handle() {
  if (id_ < 0) return;
  const Silence silence;
  close_(id_);
}

Silence::Silence() {
  // The cleanup of the HDF5 library at exit is disabled, because it fails and prints messages after reading some
  // damaged files.
  static const herr_t once = H5dont_atexit();
  (void)once;
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Silence::~Silence() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

void Group::fail(const std::string& name, const std::string& what) const {
  throw BadInput(file_ + ": " + place_ + "/" + name + ": " + what);
}

Group Group::open(const std::string& name) const {
  if (!has(name)) fail(name, "is missing");
  Handle group(H5Gopen2(group_.get(), name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail(name, fmt::format("the HDF5 group with this path cannot be read{}", last_error()));
  return Group(std::move(group), file_, place_ + "/" + name);
}

Group Group::create(const std::string& name) const {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  Handle group(H5Gcreate2(group_.get(), name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail(name, "cannot be created" + last_error());
  return Group(std::move(group), file_, place_ + "/" + name);
}

bool Group::has(const std::string& name) const {
  return H5Lexists(group_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

std::size_t Group::count() const {
  H5G_info_t info;
  if (H5Gget_info(group_.get(), &info) < 0) fail("", "cannot be listed" + last_error());
  return info.nlinks;
}

bool Group::has_attribute(const std::string& name) const {
  return H5Aexists(group_.get(), name.c_str()) > 0;
}

InputFile::InputFile(const std::filesystem::path& path)
    : file_(open_file(path)), root_(root_of(file_, path.string())) {}

DiskFile::DiskFile(const std::string& name, const std::filesystem::path& path, std::uint64_t most_bytes)
    : name_(name), path_(path), file_(create_file(name, path, most_bytes)), root_(root_of(file_, name)) {}

DiskFile::~DiskFile() {
  root_ = Group();
  file_ = Handle();
}

void DiskFile::close() {
  root_ = Group();
  file_ = Handle();
  std::array<char, kSuperblockBytes> head{};
  std::error_code error;
  if (!std::ifstream(path_, std::ios::binary).read(head.data(), head.size()))
    throw BadInput(fmt::format("{}: the written HDF5 file cannot be read back", name_));
  std::filesystem::resize_file(path_, stated_length(head.data()), error);
  if (error) throw BadInput(name_ + ": cannot be written: " + error.message());
  // If closing the file fails midway, HDF5 reports no error, but the length in the superblock differs from the file
  // length.
  if (!Handle(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose).valid())
    throw BadInput(fmt::format("{}: the HDF5 library cannot open the file that it wrote{}", name_, last_error()));
}

namespace {

herr_t survey_attribute(hid_t object, const char* name, const H5A_info_t*, void*) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) return 0;
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  H5Aget_storage_size(attribute.get());
  return 0;
}

herr_t survey_object(hid_t root, const char* name, const H5O_info_t* info, void*) {
  const Handle object(H5Oopen(root, name, H5P_DEFAULT), H5Oclose);
  if (!object.valid()) return 0;
  H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, survey_attribute, nullptr);
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  const Handle space(H5Dget_space(object.get()), H5Sclose);
  H5Dget_storage_size(object.get());
  return 0;
}

void survey(const std::filesystem::path& path) {
  const Silence silence;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file.valid()) H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_NATIVE, survey_object, nullptr, H5O_INFO_BASIC);
}

}  // namespace

void require_survivable(const std::filesystem::path& path) {
  Process child([&](int) { survey(path); }, false);
  const Process::End end = child.wait();
  if (!end.normal) {
    throw BadInput(
        fmt::format("{}: the file is damaged: the HDF5 library cannot read it ({})", path.string(), end.describe()));
  }
}

}  // namespace tumble::scenarios::hdf5
