#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bullet_ambient/force/medium/fluid_region.h"

namespace ambient::pybullet {

/// Command from PyBullet's executePluginCommand(), such as {"water": {"level": 0}}: a name, and an
/// object of values that commands.schema.json accepts. All of it is text, because PyBullet rounds
/// `floatArgs` to single precision.
struct Command {
  /// @throws std::exception with one line if the text is none
  explicit Command(const std::string& text);

  std::string name;
  nlohmann::json values;

  /// PyBullet's number of a body. @pre the schema requires it
  int body() const { return values.at("body").get<int>(); }
  /// PyBullet's number of a link.
  int link(int absent) const { return values.value("link", absent); }
  /// @throws std::invalid_argument always, with this reason, after the name
  [[noreturn]] void fail(const std::string& why) const;
};

/// Content of commands.schema.json, without what it takes from the schema of scenes.
extern const char* const kCommandSchema;

/// Returns the region that a command `water`, `air` or `region` describes.
/// @throws std::invalid_argument with one line
FluidRegion makeRegion(const Command& command);

}  // namespace ambient::pybullet
