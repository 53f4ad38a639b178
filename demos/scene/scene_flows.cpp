#include "demos/scene/scene_flows.h"

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/wind.h"
#include "demos/scene/scene_parts.h"

namespace ambient {
namespace {

using nlohmann::json;

FlowField toWindProfile(const json& from, const Vector3& up) {
  WindProfile wind;
  wind.velocity = toVector(from.at("velocity"));
  wind.height = from.value("height", wind.height);
  wind.roughness = from.value("roughness", wind.roughness);
  wind.exponent = from.value("exponent", wind.exponent);
  wind.ground = from.value("ground", wind.ground);
  wind.up = up;
  return windProfile(wind);
}

FlowField toCurrentProfile(const json& from, const Vector3& up) {
  std::vector<CurrentLevel> levels;
  for (const json& level : from.at("levels"))
    levels.push_back({level[0].get<double>(),
                      {level[1].get<double>(), level[2].get<double>(), level[3].get<double>()}});
  return currentProfile(std::move(levels), from.value("surface", 0.0), up);
}

FlowField toDiscreteGust(const json& from, const Vector3&) {
  DiscreteGust gust;
  gust.velocity = toVector(from.at("velocity"));
  gust.start = from.value("start", gust.start);
  gust.rise = from.value("rise", gust.rise);
  const auto hold = from.find("hold");
  if (hold != from.end())
    gust.hold = hold->is_null() ? std::numeric_limits<double>::infinity() : hold->get<double>();
  return discreteGust(gust);
}

FlowField toDrydenGusts(const json& from, const Vector3& up) {
  DrydenGusts gusts;
  gusts.height = from.value("height", gusts.height);
  gusts.speed = from.value("speed", gusts.speed);
  gusts.intensity = from.value("intensity", gusts.intensity);
  gusts.direction = vectorOr(from, "direction", gusts.direction);
  gusts.up = up;
  gusts.seed = from.value("seed", gusts.seed);
  return drydenGusts(gusts);
}

FlowField toGaussMarkovGusts(const json& from, const Vector3&) {
  return gaussMarkovGusts({toVector(from.at("intensity")), from.at("time").get<double>(),
                           from.value("seed", GaussMarkovGusts().seed)});
}

FlowField toTurbulence(const json& from, const Vector3&) {
  Turbulence eddies;
  eddies.length = from.value("length", eddies.length);
  eddies.intensity = from.value("intensity", eddies.intensity);
  eddies.smallest = from.value("smallest", eddies.smallest);
  eddies.carried = vectorOr(from, "carried", eddies.carried);
  eddies.seed = from.value("seed", eddies.seed);
  return turbulence(eddies);
}

constexpr std::pair<const char*, FlowField (*)(const json&, const Vector3&)> kFlowKinds[] = {
    {"wind_profile", toWindProfile},
    {"current_profile", toCurrentProfile},
    {"discrete_gust", toDiscreteGust},
    {"dryden_gusts", toDrydenGusts},
    {"gauss_markov_gusts", toGaussMarkovGusts},
    {"turbulence", toTurbulence}};

std::shared_ptr<const DensityLayers> toLayers(const json& from, const Vector3& up) {
  if (from.size() != 1)
    throw std::invalid_argument("layers: number of keys is " + std::to_string(from.size()) +
                                "; must be 1, levels or standard_atmosphere");
  if (from.contains("standard_atmosphere")) {
    const json& heights = from.at("standard_atmosphere");
    return airLayers(heights[0].get<double>(), heights[1].get<double>(), up);
  }
  std::vector<DensityLevel> levels;
  for (const json& level : from.at("levels"))
    levels.push_back({level[0].get<double>(), level[1].get<double>()});
  return layers(std::move(levels), up);
}

}  // namespace

FlowField toFlow(const json& from, const Vector3& up) {
  FlowField sum;
  for (const json& entry : from)
    for (const auto& [kind, make] : kFlowKinds)
      if (entry.contains(kind)) sum = std::move(sum) + make(entry.at(kind), up);
  return sum;
}

void readFlows(const json& from, const Vector3& upward, FluidRegion& region) {
  const Vector3 up = upward.isZero(0) ? Vector3(0, 0, 1) : upward;
  if (from.contains("flow")) region.flow = toFlow(from.at("flow"), up);
  if (from.contains("flow_above")) region.flow_above = toFlow(from.at("flow_above"), up);
  if (from.contains("layers")) region.layers = toLayers(from.at("layers"), up);
}

}  // namespace ambient
