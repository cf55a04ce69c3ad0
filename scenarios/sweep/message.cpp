// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/message.hpp"

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace tumble::scenarios {

namespace {

using nlohmann::json;

json to_json(const Setting& setting) {
  return json::array({setting.key, setting.value});
}

Setting setting_from(const json& pair) {
  return {pair.at(0).get<std::string>(), pair.at(1).get<double>()};
}

json to_json(const std::vector<Score>& scores) {
  json pairs = json::array();
  for (const Score& score : scores) pairs.push_back({score.metric, score.value});
  return pairs;
}

std::vector<Score> scores_from(const json& pairs) {
  std::vector<Score> scores;
  for (const json& pair : pairs) {
    const json& value = pair.at(1);
    scores.push_back({pair.at(0).get<std::string>(),
                      value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>()});
  }
  return scores;
}

json to_json(const Outcome& outcome) {
  return {{"scenario", outcome.scenario},
          {"seed", outcome.seed},
          {"kind", static_cast<int>(outcome.kind)},
          {"method", outcome.method},
          {"status", to_string(outcome.status)},
          {"message", outcome.message},
          {"scores", to_json(outcome.scores)},
          {"recording_digest", outcome.recording_digest},
          {"estimate_digest", outcome.estimate_digest},
          {"setting", to_json(outcome.setting)}};
}

Outcome outcome_from(const json& object) {
  Outcome outcome;
  outcome.scenario = object.at("scenario").get<std::string>();
  outcome.seed = object.at("seed").get<std::uint64_t>();
  outcome.kind = static_cast<Kind>(object.at("kind").get<int>());
  outcome.method = object.at("method").get<std::string>();
  const auto status = outcome_status_named(object.at("status").get<std::string>());
  if (!status) throw std::invalid_argument("unknown status");
  outcome.status = *status;
  outcome.message = object.at("message").get<std::string>();
  outcome.recording_digest = object.at("recording_digest").get<std::string>();
  outcome.estimate_digest = object.at("estimate_digest").get<std::string>();
  outcome.scores = scores_from(object.at("scores"));
  outcome.setting = setting_from(object.at("setting"));
  return outcome;
}

}  // namespace

std::string to_line(const Message& message) {
  json object = json::object();
  if (message.outcome) object["outcome"] = to_json(*message.outcome);
  if (message.rejected) {
    object["rejected"] = {{"scenario", message.rejected->scenario},
                          {"seed", message.rejected->seed},
                          {"message", message.rejected->message},
                          {"setting", to_json(message.rejected->setting)}};
  }
  if (message.draw) {
    object["draw"] = {{"scenario", message.draw->scenario},
                      {"seed", message.draw->seed},
                      {"values", to_json(message.draw->values)},
                      {"setting", to_json(message.draw->setting)}};
  }
  if (message.not_kept) object["not_kept"] = *message.not_kept;
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
      message.rejected =
          RejectedDraw{rejected.at("scenario").get<std::string>(), rejected.at("seed").get<std::uint64_t>(),
                       rejected.at("message").get<std::string>(), setting_from(rejected.at("setting"))};
    }
    if (object.contains("draw")) {
      const json& draw = object.at("draw");
      message.draw = DrawValues{draw.at("scenario").get<std::string>(), draw.at("seed").get<std::uint64_t>(),
                                scores_from(draw.at("values")), setting_from(draw.at("setting"))};
    }
    if (object.contains("not_kept")) message.not_kept = object.at("not_kept").get<std::string>();
    return message;
  } catch (const json::exception&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace tumble::scenarios
