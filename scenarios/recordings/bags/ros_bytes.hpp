// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fastcdr/exceptions/Exception.h>

#include <string>
#include <utility>
#include <variant>

#include "scenarios/recordings/bags/cdr_archives.hpp"
#include "scenarios/recordings/bags/ros_fields.hpp"

namespace tumble::scenarios::ros {

template <class Message>
Bytes to_ros1(Message message) {
  Ros1Writer writer;
  fields(writer, message);
  return std::move(writer.bytes);
}
template <class Message>
Bytes to_cdr(Message message) {
  CdrBound bound;
  fields(bound, message);
  CdrWriter writer(bound.bytes);
  fields(writer, message);
  return writer.bytes();
}
inline Bytes to_cdr(const Message& message) {
  return std::visit([](const auto& each) { return to_cdr(each); }, message);
}
template <class Message>
Message from_ros1(const Bytes& bytes) {
  Message message;
  Ros1Reader reader(bytes);
  fields(reader, message);
  return message;
}
template <class Message>
Message from_cdr(Bytes& bytes) {
  Message message;
  try {
    CdrReader reader(bytes);
    fields(reader, message);
  } catch (const eprosima::fastcdr::exception::Exception&) {  // thrown for truncated input
    throw BadMessage("the message has " + std::to_string(bytes.size()) +
                     " bytes; this does not fit its fields, or the type is wrong");
  }
  return message;
}

}  // namespace tumble::scenarios::ros
