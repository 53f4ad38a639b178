#include "demos/simulation/thrusters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "demos/scene/scene_water.h"

namespace ambient {

Thrusters::Thrusters(const Scene& scene, const std::vector<PreparedBody>& bodies)
    : defs_(scene.thrusters),
      factors_(defs_.size()),
      commands_(defs_.size(), 0.0),
      thrusts_(defs_.size(), 0.0) {
  for (const ThrusterDef& def : defs_) {
    arms_.push_back(def.position - bodies[def.body].centre_of_mass);
    per_thrust_.push_back(
        {arms_.back().cross(def.axis) + def.torque_per_thrust * def.axis, def.axis});
  }
  if (!defs_.empty()) setRegions(makeRegions(scene));
}

void Thrusters::command(std::size_t index, double value) {
  if (!std::isfinite(value))
    throw std::invalid_argument("the command of thruster \"" + defs_.at(index).name +
                                "\" is not finite");
  commands_.at(index) = value;
}

void Thrusters::setThrusts(const std::vector<double>& thrusts) {
  std::copy(thrusts.begin(), thrusts.end(), thrusts_.begin());
}

void Thrusters::setFactors(std::size_t index, double thrust, double lag) {
  factors_.at(index) = {thrust, lag};
}

void Thrusters::setRegions(const std::vector<FluidRegion>& regions) {
  const auto has_disc = [](const ThrusterDef& def) { return def.radius > 0; };
  const auto has_surface = [](const FluidRegion& region) { return region.surface != nullptr; };
  const auto found = std::find_if(regions.begin(), regions.end(), has_surface);
  water_.reset();
  if (found != regions.end() && std::any_of(defs_.begin(), defs_.end(), has_disc)) water_ = *found;
}

void Thrusters::follow(double time_step) {
  for (std::size_t i = 0; i < defs_.size(); ++i) {
    const double asked = factors_[i].thrust * defs_[i].thrustAt(commands_[i]);
    const double lag = factors_[i].lag * defs_[i].lag;
    thrusts_[i] += (asked - thrusts_[i]) * (time_step / (lag + time_step));
  }
}

double Thrusters::wetShare(std::size_t index, const MotionSample& pose, double time) const {
  const double radius = defs_[index].radius;
  if (!water_ || !(radius > 0)) return 1;
  const Vector3 place = pose.position + pose.orientation * arms_[index];
  if (water_->bounds && !water_->bounds->hold(place)) return 1;
  const double height = sampleRegion(*water_, place, time).height;
  return std::clamp(0.5 + height / (2 * radius), 0.0, 1.0);
}

Wrench Thrusters::wrenchOf(std::size_t index, const MotionSample& pose, double time) const {
  const double thrust = thrusts_[index];
  if (thrust == 0) return {};
  return wetShare(index, pose, time) * thrust * per_thrust_[index];
}

}  // namespace ambient
