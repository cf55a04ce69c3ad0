// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/certificate_text.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

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
