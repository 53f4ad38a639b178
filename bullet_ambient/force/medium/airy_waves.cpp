#include "bullet_ambient/force/medium/airy_waves.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

[[noreturn]] void rejectSea(const std::string& what, double value, const char* limit) {
  std::ostringstream sentence;
  sentence << what << " is " << value << "; must be " << limit;
  throw std::invalid_argument(sentence.str());
}

void checkWave(const WaveComponent& wave, std::size_t index) {
  const std::string which = "of wave " + std::to_string(index);
  if (!(wave.amplitude >= 0) || !std::isfinite(wave.amplitude))
    rejectSea("amplitude [m] " + which, wave.amplitude, "zero or positive and finite");
  if (!(wave.period > 0) || !std::isfinite(wave.period))
    rejectSea("period [s] " + which, wave.period, "positive and finite");
  if (!std::isfinite(wave.phase)) rejectSea("phase [rad] " + which, wave.phase, "finite");
}

Vector3 horizontal(const Vector3& v, const Vector3& up) { return v - up.dot(v) * up; }

}  // namespace

AiryWaves::AiryWaves(const CalmSea& sea, const std::vector<WaveComponent>& components)
    : calm_(sea.level, sea.up), current_(horizontal(sea.current, calm_.up())) {
  if (!(sea.gravity > 0) || !std::isfinite(sea.gravity))
    rejectSea("gravity of the sea [m/s^2]", sea.gravity, "positive and finite");
  if (!current_.allFinite()) rejectSea("speed of the current [m/s]", current_.norm(), "finite");
  double energy = 0, slope_squared = 0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const WaveComponent& wave = components[i];
    checkWave(wave, i);
    const Vector3 direction = horizontal(wave.direction, calm_.up());
    const double length = direction.norm();
    constexpr double kRounding = 1e-12;  // horizontal part that rounding leaves of a vertical one
    if (!(length > kRounding * wave.direction.norm()) || !std::isfinite(length))
      rejectSea("horizontal part of the direction of wave " + std::to_string(i), length,
                "positive and finite");
    const double frequency = 2 * kPi / wave.period;
    const double wave_number = frequency * frequency / sea.gravity;
    // Real waves break at a slope of 0.44.
    if (!(wave.amplitude * wave_number <= 1))
      rejectSea("slope (amplitude times wave number) of wave " + std::to_string(i),
                wave.amplitude * wave_number, "at most 1");
    waves_.push_back({wave.amplitude, frequency, wave.phase, wave_number, direction / length});
    energy += wave.amplitude * wave.amplitude;
    slope_squared += wave.amplitude * wave_number * wave.amplitude * wave_number;
  }
  if (energy > 0) wave_number_ = std::sqrt(slope_squared / energy);
}

WaterSample AiryWaves::sample(const Vector3& point_W, double time) const noexcept {
  WaterSample water = calm_.sample(point_W, time);
  water.velocity = current_;
  const double z = -std::max(0.0, water.height);
  const Vector3 carried = point_W - time * current_;
  const Vector3& up = calm_.up();
  for (const Wave& wave : waves_) {
    const double angle =
        wave.wave_number * wave.direction.dot(carried) - wave.frequency * time + wave.phase;
    const double a_cos = wave.amplitude * portable::cos(angle);
    const double a_sin = wave.amplitude * portable::sin(angle);
    const double rate = wave.frequency * portable::exp(wave.wave_number * z);
    water.height += a_cos;
    water.velocity += rate * (a_cos * wave.direction + a_sin * up);
    water.acceleration += wave.frequency * rate * (a_sin * wave.direction - a_cos * up);
  }
  return water;
}

}  // namespace ambient
