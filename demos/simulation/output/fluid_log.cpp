#include "demos/simulation/output/fluid_log.h"

#include <sstream>
#include <stdexcept>

#include "demos/simulation/output/digits.h"

namespace ambient {
namespace {

constexpr const char* kWetNames =
    ",wet_volume,wet_share,draught,wet_area,buoyancy_px,buoyancy_py,buoyancy_pz,region";

std::string valuesOf(const Vector3& v) {
  return "," + digits17(v.x()) + "," + digits17(v.y()) + "," + digits17(v.z());
}

}  // namespace

FluidLog parseFluidLog(const std::string& words) {
  FluidLog log;
  std::istringstream stream(words);
  for (std::string word; std::getline(stream, word, ',');) {
    if (word == "wrench") {
      log.wrench = true;
    } else if (word == "wet") {
      log.wet = true;
    } else {
      throw std::invalid_argument("--log: \"" + word + "\" is none of wrench, wet");
    }
  }
  return log;
}

std::string fluidLogHeader(const FluidLog& log) {
  std::string names;
  if (log.wrench)
    for (const auto& [part, wrench] : kWrenchParts)
      for (const char* component : {"_tx", "_ty", "_tz", "_fx", "_fy", "_fz"})
        names += std::string(",") + part + component;
  return log.wet ? names + kWetNames : names;
}

std::string fluidLogRow(const FluidLog& log, const Simulation& simulation, std::size_t body) {
  std::string row;
  if (log.wrench) {
    const FluidWrench read = simulation.wrench(body);
    for (const auto& [part, wrench] : kWrenchParts)
      row += valuesOf((read.*wrench).torque) + valuesOf((read.*wrench).force);
  }
  if (!log.wet) return row;
  const WetState wet = simulation.wet(body);
  for (const double value : {wet.volume, wet.share, wet.draught, wet.area})
    row += "," + digits17(value);
  return row + valuesOf(wet.centre_of_buoyancy) + "," +
         std::to_string(static_cast<int>(wet.region));
}

}  // namespace ambient
