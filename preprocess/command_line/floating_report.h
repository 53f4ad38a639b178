#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "preprocess/floating/floating_attitudes.h"

namespace ambient {

/// Returns a text about how a body floats: its attitudes with draught, metacentric heights and
/// periods.
std::string floatingTable(const FloatingBody& body);

/// Returns the facts of floatingTable() in JSON: a list with one entry per attitude, empty if the
/// body sinks.
nlohmann::ordered_json floatingJson(const FloatingBody& body);

}  // namespace ambient
