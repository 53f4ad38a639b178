#include "demos/simulation/scene_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "demos/simulation/output/motion_recorder.h"

namespace ambient {

std::string digits17(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::vector<double> outputTimes(const Scene& scene) {
  return timesOf(0, scene.duration, scene.output_step);
}

long long countSteps(double duration, double time_step) {
  constexpr double kRounding = 1e-9;  // tolerance for decimal numbers in binary
  return static_cast<long long>(std::ceil(duration / time_step * (1 - kRounding)));
}

namespace {

constexpr const char* kWetNames =
    ",wet_volume,wet_share,draught,wet_area,buoyancy_px,buoyancy_py,buoyancy_pz,region";

std::string valuesOf(const Vector3& v) {
  return "," + digits17(v.x()) + "," + digits17(v.y()) + "," + digits17(v.z());
}

constexpr const char* kHoldNames[] = {"volume",   "inflow",  "freeboard", "air_pressure",
                                      "level_x",  "level_y", "level_z",   "normal_x",
                                      "normal_y", "normal_z"};

std::size_t mostHolds(const std::vector<PreparedBody>& bodies) {
  std::size_t most = 0;
  for (const PreparedBody& body : bodies)
    if (body.fluid_body) most = std::max(most, body.fluid_body->holds.size());
  return most;
}

// Cells of a body with fewer holds than others are empty.
std::string holdValues(const std::vector<HoldWater>& holds, std::size_t most_holds) {
  std::string row;
  for (const HoldWater& water : holds) {
    for (const double value : {water.volume, water.inflow, water.freeboard, water.air_pressure})
      row += "," + digits17(value);
    row += valuesOf(water.level) + valuesOf(water.normal);
  }
  return row + std::string((most_holds - holds.size()) * std::size(kHoldNames), ',');
}

// Values of one body now, each after a comma; 17 significant digits.
std::string rowOf(const FluidLog& log, const Simulation& simulation, std::size_t body,
                  std::size_t most_holds) {
  std::string row;
  if (log.wrench) {
    const FluidWrench read = simulation.wrench(body);
    for (const auto& [part, wrench] : kWrenchParts)
      row += valuesOf((read.*wrench).torque) + valuesOf((read.*wrench).force);
  }
  if (log.wet) {
    const WetState wet = simulation.wet(body);
    for (const double value : {wet.volume, wet.share, wet.draught, wet.area})
      row += "," + digits17(value);
    row += valuesOf(wet.centre_of_buoyancy) + "," + std::to_string(static_cast<int>(wet.region));
  }
  return log.holds ? row + holdValues(simulation.holds(body), most_holds) : row;
}

// Rows of the log for all output times that the motion has come to.
void addLog(const FluidLog& log, const Simulation& simulation, std::size_t most_holds,
            RunRecord& record, const std::vector<std::vector<MotionSample>>& motion) {
  if (log.isEmpty()) return;
  record.log.resize(motion.size());
  for (std::size_t body = 0; body < motion.size(); ++body)
    if (record.log[body].size() < motion[body].size())
      record.log[body].resize(motion[body].size(), rowOf(log, simulation, body, most_holds));
}

}  // namespace

RunRecord runScene(const Scene& scene, const std::vector<PreparedBody>& bodies,
                   const RunProgress& progress, const FluidLog& log) {
  using Clock = std::chrono::steady_clock;
  RunRecord record;
  record.steps = countSteps(scene.duration, scene.time_step);
  Simulation simulation(scene, bodies);
  MotionRecorder recorder(outputTimes(scene), scene.time_step);
  for (std::size_t i = 0; log.wrench && i < bodies.size(); ++i) simulation.readWrench(i, true);
  const std::size_t most_holds = mostHolds(bodies);
  recorder.add(simulation.sample());
  addLog(log, simulation, most_holds, record, recorder.motion());
  Clock::duration stepping{};
  for (long long i = 0; i < record.steps; ++i) {
    const auto start = Clock::now();
    simulation.step();
    stepping += Clock::now() - start;
    recorder.add(simulation.sample());
    addLog(log, simulation, most_holds, record, recorder.motion());
    if (!progress(static_cast<double>(i + 1) / static_cast<double>(record.steps)))
      throw RunStopped();
  }
  record.wall_seconds = std::chrono::duration<double>(stepping).count();
  record.motion = std::move(recorder.motion());
  for (std::size_t i = 0; i < bodies.size(); ++i) record.work.push_back(simulation.work(i));
  record.warning = simulation.warning();
  return record;
}

FluidLog parseFluidLog(const std::string& words) {
  FluidLog log;
  std::istringstream stream(words);
  for (std::string word; std::getline(stream, word, ',');) {
    if (word == "wrench") {
      log.wrench = true;
    } else if (word == "wet") {
      log.wet = true;
    } else if (word == "holds") {
      log.holds = true;
    } else {
      throw std::invalid_argument("--log: \"" + word + "\" is none of wrench, wet, holds");
    }
  }
  return log;
}

std::string fluidLogHeader(const FluidLog& log, const std::vector<PreparedBody>& bodies) {
  std::string names;
  if (log.wrench)
    for (const auto& [part, wrench] : kWrenchParts)
      for (const char* component : {"_tx", "_ty", "_tz", "_fx", "_fy", "_fz"})
        names += std::string(",") + part + component;
  if (log.wet) names += kWetNames;
  for (std::size_t hold = 0; log.holds && hold < mostHolds(bodies); ++hold)
    for (const char* name : kHoldNames) names += ",hold" + std::to_string(hold) + "_" + name;
  return names;
}

}  // namespace ambient
