// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/hdf5_survey.hpp"

#include <fmt/format.h>

#include "scenarios/errors.hpp"
#include "scenarios/processes/process.hpp"
#include "scenarios/recordings/hdf5_file.hpp"

namespace tumble::scenarios::hdf5 {

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
