#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "preprocess/floating/floating_attitudes.h"

namespace ambient {

/// How a body floats, for people: its attitudes with draught, metacentric heights and periods.
std::string floatingTable(const FloatingBody& body);

/// The same as a list, one entry per attitude; empty: it sinks.
nlohmann::ordered_json floatingJson(const FloatingBody& body);

}  // namespace ambient
