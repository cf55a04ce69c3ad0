// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "sim/parameters.hpp"

/// Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// Origin of a message: the location for error messages, and the time of the record.
struct MessageOrigin {
  std::string where;
  std::int64_t record_ns;
};

/// An open bag with its topics and its location for error messages.
struct OpenedBag {
  BagReader& reader;
  std::string place;
  std::vector<BagTopic> topics;

  const BagTopic& topic(const std::string& name) const {
    std::vector<std::string> names;
    for (const BagTopic& each : topics) {
      if (each.name == name) return each;
      names.push_back(each.name);
    }
    const std::string near = sim::nearest_name(name, names);
    throw BadInput(place + ": there is no topic '" + name + "'" +
                   (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }

  /// Returns the named topics, which must have a matching type; without names, returns all topics of a matching type.
  std::vector<std::string> chosen(const std::vector<std::string>& names, bool (*fits)(const std::string& type),
                                  const std::string& wanted) const {
    std::vector<std::string> out = names;
    for (const std::string& name : names) {
      if (!fits(topic(name).type))
        throw BadInput(place + ": topic '" + name + "' is of type " + topic(name).type + ", must be " + wanted);
    }
    for (const BagTopic& each : topics) {
      if (names.empty() && fits(each.type)) out.push_back(each.name);
    }
    return out;
  }

  /// Calls `take(message, origin)` for each message of the topic.
  template <class Message, class Take>
  void read(const std::string& name, Take&& take) const {
    std::size_t number = 0;
    reader.read(name, [&](ros::Bytes& bytes, std::int64_t record_ns) {
      const std::string where = place + ": message " + std::to_string(number++) + " of " + name;
      Message message;
      try {
        message = reader.cdr(name) ? ros::from_cdr<Message>(bytes) : ros::from_ros1<Message>(bytes);
      } catch (const ros::BadMessage& error) {
        throw BadInput(where + ": " + error.what());
      }
      take(message, MessageOrigin{where, record_ns});
    });
  }
};

}  // namespace tumble::scenarios
