// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

struct MessageOrigin {
  std::string where;
  std::int64_t record_ns;
  std::size_t number;  ///< index of the message in its topic
};

struct OpenedBag {
  BagReader& reader;
  std::string place;
  std::vector<BagTopic> topics;

  using FitsType = bool (*)(const std::string& type);

  /// Finds a topic by its name, with or without the leading slash, or by the name that the topic's sensor has in a
  /// recording.
  const BagTopic& topic(const std::string& name, FitsType fits = nullptr) const {
    std::vector<std::string> names;
    for (const BagTopic& each : topics) {
      if (each.name == name) return each;
      if (fits == nullptr || fits(each.type)) names.push_back(each.name);
    }
    for (const BagTopic& each : topics) {
      if (std::ranges::count(names, each.name) > 0 && (each.name == "/" + name || sensor_name(each.name) == name))
        return each;
    }
    const std::string near = sim::did_you_mean(name, names);
    throw WrongOption(place + ": there is no topic '" + name + "'" + (near.empty() ? "" : "; " + near) +
                      topic_list(fits));
  }

  /// Lists the topics whose message type fits; if no type fits, lists all topics.
  std::string topic_list(FitsType fits = nullptr) const {
    std::string out;
    for (const BagTopic& each : topics) {
      if (fits == nullptr || fits(each.type)) out += (out.empty() ? " " : ", ") + each.name + " " + each.type;
    }
    if (fits != nullptr && out.empty()) return topic_list();
    return (fits != nullptr ? " (topics of a fitting type:" : " (existing topics:") + (out.empty() ? " none" : out) +
           ")";
  }

  std::string place_of(const std::string& name, std::size_t message) const {
    return place + ": message " + std::to_string(message) + " of " + name;
  }

  std::vector<std::string> chosen(const std::vector<std::string>& names, FitsType fits,
                                  const std::string& wanted) const {
    std::vector<std::string> out;
    for (const std::string& name : names) {
      const BagTopic& found = topic(name, fits);
      if (!fits(found.type))
        throw WrongOption(place + ": topic '" + found.name + "' is of type " + found.type + "; it must be " + wanted +
                          topic_list(fits));
      out.push_back(found.name);
    }
    for (const BagTopic& each : topics) {
      if (names.empty() && fits(each.type)) out.push_back(each.name);
    }
    return out;
  }

  /// A message that cannot be decoded is counted in `left_out`. If `left_out` is null, a message that cannot be decoded
  /// throws BadInput.
  template <class Message, class Take>
  void read(const std::string& name, Take&& take, LeftOut* left_out = nullptr) const {
    std::size_t number = 0;
    reader.read(name, [&](ros::Bytes& bytes, std::int64_t record_ns) {
      const std::string where = place_of(name, number++);
      Message message;
      try {
        message = reader.cdr(name) ? ros::from_cdr<Message>(bytes) : ros::from_ros1<Message>(bytes);
      } catch (const ros::BadMessage& error) {
        if (left_out == nullptr) throw BadInput(where + ": " + error.what());
        return left_out->add("faulty data", where + ": " + error.what());
      }
      take(message, MessageOrigin{where, record_ns, number - 1});
    });
  }
};

}  // namespace tumble::scenarios
