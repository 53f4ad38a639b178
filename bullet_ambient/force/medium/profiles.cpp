#include "bullet_ambient/force/medium/profiles.h"

#include <algorithm>
#include <cmath>
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

}  // namespace ambient
