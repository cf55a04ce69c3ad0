// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/certificate_store.hpp"

#include <array>
#include <fstream>
#include <sstream>

#include "scenarios/certificate/certificate_text.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/provenance/build_id.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/provenance/text_digest.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("model name")) return line;
  }
  return "unknown";
}

}  // namespace

CertificateStore::CertificateStore(std::filesystem::path folder, const DataRoot& data) {
  if (folder.empty()) return;
  const std::array<std::string, 3> key = {build_id(), data_digest(data), processor()};
  file_ = folder / ("certificate_" + digest_of_texts(key) + ".json");
}

std::optional<Certificate> CertificateStore::find() const {
  std::ifstream file(file_);
  if (file_.empty() || !file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  try {
    Certificate certificate = certificate_from_json(text.str(), file_.string());
    if (certificate.build == build_id() && !certificate.entries.empty()) return certificate;
  } catch (const BadInput&) {  // invalid file: measure again
  }
  return std::nullopt;
}

void CertificateStore::keep(const Certificate& certificate) const {
  if (file_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file_.parent_path(), ignored);
  try {
    replace_file(file_, to_json(certificate));
  } catch (const BadInput&) {  // the cache is optional: ignore the error
  }
}

}  // namespace tumble::scenarios
