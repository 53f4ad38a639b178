#include "demos/scene/scene_water.h"

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "bullet_ambient/force/medium/waves.h"
#include "demos/scene/scene_flows.h"
#include "demos/scene/scene_parts.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Reads a corner [m]; a coordinate that is null becomes `open`.
Vector3 cornerAt(const json& bounds, const char* key, double open) {
  Vector3 corner = Vector3::Constant(open);
  const auto found = bounds.find(key);
  if (found == bounds.end()) return corner;
  for (int axis = 0; axis < 3; ++axis) {
    const json& side = found->at(static_cast<std::size_t>(axis));
    if (!side.is_null()) corner[axis] = side.get<double>();
  }
  return corner;
}

WaveComponent toWave(const json& from) {
  WaveComponent wave;
  wave.amplitude = from.at("amplitude").get<double>();
  wave.period = from.at("period").get<double>();
  wave.direction = vectorOr(from, "direction", wave.direction);
  wave.phase = from.value("phase", wave.phase);
  return wave;
}

WaveSpectrum toSpectrum(const json& from) {
  WaveSpectrum spectrum;
  spectrum.significant_height = from.at("significant_height").get<double>();
  spectrum.peak_period = from.at("peak_period").get<double>();
  spectrum.peak_enhancement = from.value("peak_enhancement", spectrum.peak_enhancement);
  spectrum.direction = vectorOr(from, "direction", spectrum.direction);
  spectrum.components = from.value("components", spectrum.components);
  spectrum.seed = from.value("seed", spectrum.seed);
  return spectrum;
}

std::vector<WaveComponent> toWaves(const json& water) {
  std::vector<WaveComponent> waves;
  if (water.contains("spectrum")) waves = wavesOf(toSpectrum(water.at("spectrum")));
  if (water.contains("waves"))
    for (const json& wave : water.at("waves")) waves.push_back(toWave(wave));
  return waves;
}

// Checks a region of makeRegions(); messages use the name of the region in the scene file.
void check(const FluidRegion& region, std::size_t index, bool has_water) {
  const std::string name = has_water && index == 0
                               ? "water"
                               : "regions[" + std::to_string(index - (has_water ? 1 : 0)) + "]";
  try {
    checkRegion(region);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
}

}  // namespace

Medium toMedium(const json& from, const Medium& absent) {
  Medium medium;
  medium.density = from.value("density", absent.density);
  medium.viscosity = from.value("viscosity", absent.viscosity);
  medium.velocity = vectorOr(from, "velocity", absent.velocity);
  medium.acceleration = vectorOr(from, "acceleration", absent.acceleration);
  return medium;
}

WaterDef toWater(const json& from, const Vector3& gravity) {
  WaterDef def;
  def.medium = toMedium(from, water());
  def.sea.level = from.at("level").get<double>();
  def.sea.up = -gravity;
  def.sea.gravity = gravity.norm();
  def.sea.current = vectorOr(from, "current", def.sea.current);
  def.waves = toWaves(from);
  def.bounds = toBounds(from);
  readFlows(from, vectorOr(from, "up", -gravity), def.flows);
  return def;
}

FluidRegion toRegion(const json& from, const Vector3& gravity) {
  FluidRegion region;
  region.bounds = toBounds(from);
  region.below = toMedium(from.at("medium"), Medium{});
  region.priority = from.value("priority", 0);
  readFlows(from, -gravity, region);
  return region;
}

std::optional<RegionBounds> toBounds(const json& parent) {
  const auto found = parent.find("bounds");
  if (found == parent.end()) return std::nullopt;
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  return RegionBounds{cornerAt(*found, "lowest", -kOpen), cornerAt(*found, "highest", kOpen)};
}

FluidRegion makeWaterRegion(const WaterDef& water, const std::optional<Medium>& above) {
  FluidRegion region = water.flows;
  region.bounds = water.bounds;
  region.below = water.medium;
  region.above = above;
  if (water.waves.empty()) {
    region.surface = std::make_shared<StillWater>(water.sea.level, water.sea.up);
    region.below.velocity = water.sea.current;
  } else {
    region.surface = std::make_shared<AiryWaves>(water.sea, water.waves);
  }
  return region;
}

std::vector<FluidRegion> makeRegions(const Scene& scene) {
  std::vector<FluidRegion> regions;
  if (scene.water) regions.push_back(makeWaterRegion(*scene.water, scene.medium));
  regions.insert(regions.end(), scene.regions.begin(), scene.regions.end());
  for (std::size_t i = 0; i < regions.size(); ++i) check(regions[i], i, scene.water.has_value());
  return regions;
}

}  // namespace ambient
