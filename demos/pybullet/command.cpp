#include "demos/pybullet/command.h"

#include <optional>
#include <stdexcept>

#include "demos/scene/scene_flows.h"
#include "demos/scene/scene_parts.h"
#include "demos/scene/scene_water.h"
#include "preprocess/shape/json_schema.h"

namespace ambient::pybullet {
namespace {

nlohmann::json makeSchema() {
  auto schema = nlohmann::json::parse(kCommandSchema);
  schema["definitions"].update(sceneSchema().document().at("definitions"));
  return schema;
}

FluidRegion readWater(const nlohmann::json& from) {
  const CalmSea usual;
  WaterDef water = toWater(from, Vector3(0, 0, -usual.gravity));
  water.sea.up = vectorOr(from, "up", usual.up);
  water.sea.gravity = from.value("gravity", usual.gravity);
  std::optional<Medium> above;
  if (from.contains("wind")) {
    above = air();
    above->velocity = toVector(from.at("wind"));
  }
  return makeWaterRegion(water, above);
}

FluidRegion readRegion(const Command& command) {
  if (command.name == "water") return readWater(command.values);
  const bool is_air = command.name == "air";
  FluidRegion region;
  region.below = toMedium(command.values, is_air ? air() : water());
  if (is_air) region.below.velocity = vectorOr(command.values, "wind", Vector3::Zero());
  region.bounds = toBounds(command.values);
  readFlows(command.values, CalmSea().up, region);
  return region;
}

}  // namespace

Command::Command(const std::string& text) {
  if (text.empty())
    throw std::invalid_argument("the command is empty: PyBullet drops texts of 1024 and more");
  static const nlohmann::json document = makeSchema();
  const nlohmann::json command = parseJson(text, "the command");
  JsonSchema(document, "the command").check(command, "the command");
  if (command.size() != 1)
    throw std::invalid_argument("the command must have one name, not " +
                                std::to_string(command.size()));
  name = command.begin().key();
  values = command.front();
}

void Command::fail(const std::string& why) const { throw std::invalid_argument(name + ": " + why); }

FluidRegion makeRegion(const Command& command) {
  try {
    FluidRegion region = readRegion(command);
    region.priority = command.values.value("priority", 0);
    checkRegion(region);
    return region;
  } catch (const std::invalid_argument& error) {
    command.fail(error.what());
  }
}

}  // namespace ambient::pybullet
