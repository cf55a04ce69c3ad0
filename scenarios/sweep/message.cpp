// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/message.hpp"

#include <limits>
#include <nlohmann/json.hpp>

namespace tumble::scenarios {

namespace {

using nlohmann::json;

json to_json(const Outcome& outcome) {
  json scores = json::array();
  for (const Score& score : outcome.scores) scores.push_back({score.metric, score.value});
  return {{"scenario", outcome.scenario},
          {"seed", outcome.seed},
          {"kind", static_cast<int>(outcome.kind)},
          {"method", outcome.method},
          {"status", outcome.status},
          {"message", outcome.message},
          {"scores", scores},
          {"recording_digest", outcome.recording_digest},
          {"estimate_digest", outcome.estimate_digest}};
}

Outcome outcome_from(const json& object) {
  Outcome outcome;
  outcome.scenario = object.at("scenario").get<std::string>();
  outcome.seed = object.at("seed").get<std::uint64_t>();
  outcome.kind = static_cast<Kind>(object.at("kind").get<int>());
  outcome.method = object.at("method").get<std::string>();
  outcome.status = object.at("status").get<std::string>();
  outcome.message = object.at("message").get<std::string>();
  outcome.recording_digest = object.at("recording_digest").get<std::string>();
  outcome.estimate_digest = object.at("estimate_digest").get<std::string>();
  for (const json& score : object.at("scores")) {
    const json& value = score.at(1);
    outcome.scores.push_back({score.at(0).get<std::string>(),
                              value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>()});
  }
  return outcome;
}

}  // namespace

std::string to_line(const Message& message) {
  json object = json::object();
  if (message.outcome) object["outcome"] = to_json(*message.outcome);
  if (message.rejected) {
    object["rejected"] = {{"scenario", message.rejected->scenario},
                          {"seed", message.rejected->seed},
                          {"message", message.rejected->message}};
  }
  // text that is not UTF-8 must not stop an outcome
  return object.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::optional<Message> from_line(const std::string& line) {
  try {
    const json object = json::parse(line);
    if (!object.is_object()) return std::nullopt;
    Message message;
    if (object.contains("outcome")) message.outcome = outcome_from(object.at("outcome"));
    if (object.contains("rejected")) {
      const json& rejected = object.at("rejected");
      message.rejected = RejectedDraw{rejected.at("scenario").get<std::string>(),
                                      rejected.at("seed").get<std::uint64_t>(),
                                      rejected.at("message").get<std::string>()};
    }
    return message;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace tumble::scenarios
