// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/certificate_store.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scenarios/errors.hpp"
#include "scenarios/provenance/build_id.hpp"
#include "scenarios/provenance/data_digest.hpp"
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

namespace {

using nlohmann::json;

json finite(double value) {
  return std::isfinite(value) ? json(value) : json();
}

double number(const json& value) {
  return value.is_null() ? std::nan("") : value.get<double>();
}

const char* verdict(bool passes) {
  return passes ? "pass" : "fail";
}

}  // namespace

std::string to_json(const Certificate& certificate) {
  json entries = json::array();
  for (const CertificateEntry& entry : certificate.entries) {
    entries.push_back({{"row", entry.row},
                       {"subject", entry.subject},
                       {"law", entry.law},
                       {"unit", entry.unit},
                       {"value", finite(entry.value)},
                       {"low", finite(entry.low)},
                       {"high", finite(entry.high)},
                       {"verdict", verdict(entry.passes())},
                       {"note", entry.note}});
  }
  const json document = {
      {"build", certificate.build}, {"verdict", verdict(certificate.passes())}, {"entries", std::move(entries)}};
  return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

Certificate certificate_from_json(const std::string& text, const std::string& place) {
  try {
    const json document = json::parse(text);
    Certificate certificate;
    certificate.build = document.at("build").get<std::string>();
    for (const json& entry : document.at("entries")) {
      const auto word = [&](const char* key) { return entry.at(key).get<std::string>(); };
      certificate.entries.push_back({word("row"), word("subject"), word("law"), word("unit"), number(entry.at("value")),
                                     number(entry.at("low")), number(entry.at("high")), word("note")});
    }
    return certificate;
  } catch (const json::exception& error) {
    throw BadInput(place + ": not a certificate: " + error.what());
  }
}

}  // namespace tumble::scenarios
