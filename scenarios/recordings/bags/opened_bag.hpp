// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
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

  const BagTopic& topic(const std::string& name) const {
    std::vector<std::string> names;
    for (const BagTopic& each : topics) {
      if (each.name == name) return each;
      names.push_back(each.name);
    }
    const std::string near = sim::nearest_name(name, names);
    throw BadInput(place + ": there is no topic '" + name + "'" +
                   (near.empty() ? "" : "; did you mean '" + near + "'?") + " (existing topics:" + topic_list() + ")");
  }

  std::string topic_list() const {
    std::string out;
    for (const BagTopic& each : topics) out += (out.empty() ? " " : ", ") + each.name + " " + each.type;
    return out.empty() ? " none" : out;
  }

  std::string place_of(const std::string& name, std::size_t message) const {
    return place + ": message " + std::to_string(message) + " of " + name;
  }

  std::vector<std::string> chosen(const std::vector<std::string>& names, bool (*fits)(const std::string& type),
                                  const std::string& wanted) const {
    std::vector<std::string> out = names;
    for (const std::string& name : names) {
      if (!fits(topic(name).type))
        throw BadInput(place + ": topic '" + name + "' is of type " + topic(name).type + "; it must be " + wanted);
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
