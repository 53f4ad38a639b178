#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/temporary_folder.h"

namespace ambient {

/// Whether a message is the expected one, in which "..." at the beginning or end stands for any
/// text.
inline bool isMessage(const std::string& message, std::string expected) {
  const auto takeDots = [&expected](std::size_t place) {
    const bool found = expected.compare(place, 3, "...") == 0;
    if (found) expected.erase(place, 3);
    return found;
  };
  const bool may_begin = takeDots(0);
  const bool may_end = expected.size() >= 3 && takeDots(expected.size() - 3);
  const std::size_t place = message.find(expected);
  return place != std::string::npos && (may_begin || place == 0) &&
         (may_end || place + expected.size() == message.size());
}

/// Expects the messages of a group in a file of refused inputs, {"group": [[input, message], ...]},
/// each on one line. An empty one: the input is accepted. Calls `complaintAbout(input)`.
template <class Complaint>
void expectRefusals(const std::filesystem::path& file, const std::string& group,
                    const Complaint& complaintAbout) {
  const nlohmann::json rows = nlohmann::json::parse(readText(file)).at(group);
  EXPECT_FALSE(rows.empty());
  for (const nlohmann::json& row : rows) {
    const std::string message = complaintAbout(row.at(0));
    EXPECT_TRUE(isMessage(message, row.at(1))) << row << "\nis refused by\n" << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

/// Returns a value after changes {"/pointer": value, ...}; null erases.
inline nlohmann::json withChanges(nlohmann::json value, const nlohmann::json& changes) {
  for (const auto& [pointer, part] : changes.items()) {
    const nlohmann::json::json_pointer place(pointer);
    if (part.is_null()) {
      value.at(place.parent_pointer()).erase(place.back());
    } else {
      value[place] = part;
    }
  }
  return value;
}

}  // namespace ambient
