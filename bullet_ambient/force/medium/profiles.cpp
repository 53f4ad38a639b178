#include "bullet_ambient/force/medium/profiles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/input_checks.h"

namespace ambient {
namespace {

// Returns a flow that changes with height alone. `change`: of the velocity over height [1/s].
FlowSample shearedFlow(const Vector3& velocity, const Vector3& change, const Vector3& up) {
  return {velocity, Vector3::Zero(), change * up.transpose()};
}

}  // namespace

FlowField operator+(FlowField a, FlowField b) {
  if (!a) return b;
  if (!b) return a;
  return [a = std::move(a), b = std::move(b)](const Vector3& point_W, double time) {
    return sumOf(a(point_W, time), b(point_W, time));
  };
}

FlowField windProfile(const WindProfile& wind) {
  const InputChecks check{"wind profile"};
  const Vector3 up = check.direction("up", wind.up);
  const Vector3 velocity =
      check.finite("velocity [m/s]", wind.velocity) - wind.velocity.dot(up) * up;
  check.positive("height [m]", wind.height);
  check.require(wind.roughness >= 0 && wind.roughness < wind.height, "roughness [m]",
                wind.roughness, "from 0 to below the height");
  check.within("exponent", wind.exponent, 0, 1);
  check.finite("ground [m]", wind.ground);
  const double ground = wind.ground, roughness = wind.roughness, height = wind.height;
  if (roughness > 0)
    return [=, over = Vector3(velocity / portable::log(height / roughness))](const Vector3& point_W,
                                                                             double) {
      const double z = up.dot(point_W) - ground;
      if (!(z > roughness)) return FlowSample{};
      return shearedFlow(portable::log(z / roughness) * over, over / z, up);
    };
  return [=, exponent = wind.exponent](const Vector3& point_W, double) {
    const double z = up.dot(point_W) - ground;
    if (!(z > 0)) return FlowSample{};
    const Vector3 there = portable::pow(z / height, exponent) * velocity;
    return shearedFlow(there, exponent / z * there, up);
  };
}

FlowField currentProfile(std::vector<CurrentLevel> levels, double surface, const Vector3& upward) {
  const InputChecks check{"current profile"};
  const Vector3 up = check.direction("up", upward);
  check.finite("surface [m]", surface);
  check.require(!levels.empty(), "number of levels", 0, "at least 1");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::string which = " of level " + std::to_string(i);
    const double before = i > 0 ? levels[i - 1].depth : 0;
    check.require(levels[i].depth >= before && std::isfinite(levels[i].depth), "depth [m]" + which,
                  levels[i].depth, "finite, and at least that of the level before and 0");
    Vector3& velocity = levels[i].velocity;
    check.finite("velocity [m/s]" + which, velocity);
    velocity -= velocity.dot(up) * up;
  }
  return [=, levels = std::move(levels)](const Vector3& point_W, double) {
    const double depth = surface - up.dot(point_W);
    if (!(depth >= 0)) return FlowSample{};
    const auto next =
        std::lower_bound(levels.begin(), levels.end(), depth,
                         [](const CurrentLevel& level, double d) { return level.depth < d; });
    if (next == levels.begin()) return FlowSample{levels.front().velocity};
    if (next == levels.end()) return FlowSample{levels.back().velocity};
    const CurrentLevel& last = *(next - 1);
    const Vector3 change = (next->velocity - last.velocity) / (next->depth - last.depth);
    return shearedFlow(last.velocity + (depth - last.depth) * change, -change, up);
  };
}

FlowField discreteGust(const DiscreteGust& gust) {
  const InputChecks check{"discrete gust"};
  check.finite("velocity [m/s]", gust.velocity);
  check.finite("start [s]", gust.start);
  check.positive("rise [s]", gust.rise);
  check.require(gust.hold >= 0, "hold [s]", gust.hold, "zero or positive");
  return [gust](const Vector3&, double time) {
    const double since = time - gust.start, until = 2 * gust.rise + gust.hold - since;
    const double elapsed = std::min(since, until);  // from the nearer end
    if (!(elapsed > 0)) return FlowSample{};
    if (elapsed >= gust.rise) return FlowSample{gust.velocity};
    const double rate = kPi / gust.rise;
    const auto [sine, cosine] = portable::sineAndCosine(rate * elapsed);
    const double sign = since < until ? 1 : -1;
    return FlowSample{(1 - cosine) / 2 * gust.velocity, sign * rate * sine / 2 * gust.velocity};
  };
}

namespace {

double interpolated(const DensityLevel& low, const DensityLevel& high, double height) noexcept {
  const double part = (height - low.height) / (high.height - low.height);
  return low.density + part * (high.density - low.density);
}

// Layer of the standard from a geopotential height on [m], with its temperature [K] and lapse rate
// [K/m] there.
struct AirLayer {
  double height, temperature, rate;
};
constexpr AirLayer kAir[] = {{0, 288.15, -0.0065},    {11000, 216.65, 0}, {20000, 216.65, 0.001},
                             {32000, 228.65, 0.0028}, {47000, 270.65, 0}, {51000, 270.65, -0.0028},
                             {71000, 214.65, -0.002}, {84852, 186.946, 0}};
constexpr double kGasConstant = 8314.32 / 28.9644;  // R*/M_0 [J/(kg K)]
constexpr double kGravity = 9.80665;                // [m/s^2]

// Returns pressure at a height over that at the base of its layer [1].
double pressureRatio(const AirLayer& base, double rise) {
  if (base.rate == 0) return portable::exp(-kGravity * rise / (kGasConstant * base.temperature));
  const double warmth = (base.temperature + base.rate * rise) / base.temperature;
  return portable::pow(warmth, -kGravity / (kGasConstant * base.rate));
}

}  // namespace

DensityLayers::DensityLayers(std::vector<DensityLevel> levels, const Vector3& up)
    : levels_(std::move(levels)), up_(up.normalized()) {
  if (!(up.norm() > 0) || !up.allFinite())
    throw std::invalid_argument("the direction up of the layers has no length, or is not finite");
  if (levels_.empty()) throw std::invalid_argument("the layers have no level; must have one");
  const InputChecks check;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const std::string which = "of level " + std::to_string(i) + " of the layers";
    const DensityLevel& level = levels_[i];
    check.finite("height [m] " + which, level.height);
    check.require(i == 0 || level.height >= levels_[i - 1].height, "height [m] " + which,
                  level.height, "at least that of the level before");
    check.notNegative("density [kg/m^3] " + which, level.density);
  }
}

double DensityLayers::density(double height) const noexcept {
  const auto above =
      std::lower_bound(levels_.begin(), levels_.end(), height,
                       [](const DensityLevel& level, double h) { return level.height < h; });
  if (above == levels_.begin()) return levels_.front().density;
  if (above == levels_.end()) return levels_.back().density;
  return interpolated(*(above - 1), *above, height);
}

std::shared_ptr<const DensityLayers> layers(std::vector<DensityLevel> levels, const Vector3& up) {
  return std::make_shared<const DensityLayers>(std::move(levels), up);
}

Medium standardAtmosphere(double height) {
  constexpr double kLowest = -5000, kHighest = 86000, kEarth = 6356766;
  InputChecks{}.within("height in the standard atmosphere [m]", height, kLowest, kHighest);
  const double geopotential = kEarth * height / (kEarth + height);
  const AirLayer* base = kAir;
  double pressure = 101325;
  for (; base + 1 < std::end(kAir) && base[1].height < geopotential; ++base)
    pressure *= pressureRatio(*base, base[1].height - base->height);
  const double rise = geopotential - base->height;
  pressure *= pressureRatio(*base, rise);
  const double temperature = base->temperature + base->rate * rise;
  Medium air;
  air.density = pressure / (kGasConstant * temperature);
  air.viscosity = 1.458e-6 * temperature * std::sqrt(temperature) / (temperature + 110.4);
  return air;
}

std::shared_ptr<const DensityLayers> airLayers(double lowest, double highest, const Vector3& up) {
  constexpr double kStep = 100;
  InputChecks{}.require(highest > lowest, "highest level of the air [m]", highest,
                        "above the lowest");
  const double density = standardAtmosphere(highest).density;  // refuses before the loop
  std::vector<DensityLevel> levels;
  for (double height = lowest; height < highest; height += kStep)
    levels.push_back({height, standardAtmosphere(height).density});
  levels.push_back({highest, density});
  return layers(std::move(levels), up);
}

}  // namespace ambient
