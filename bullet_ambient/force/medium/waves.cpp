#include "bullet_ambient/force/medium/waves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/philox.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/input_checks.h"

namespace ambient {

StillWater::StillWater(double level, const Vector3& up) : level_(level), up_(up.normalized()) {
  if (!std::isfinite(level)) throw std::invalid_argument("the level of the water is not finite");
  if (!(up.norm() > 0) || !up.allFinite())
    throw std::invalid_argument("the direction up of the water has no length, or is not finite");
}

WaterSample StillWater::sample(const Vector3& point_W, double) const noexcept {
  return {level_ - up_.dot(point_W), {0, 0, 0}, {0, 0, 0}};
}

WaterSurfaceFunction::WaterSurfaceFunction(Function function) : function_(std::move(function)) {
  if (!function_) throw std::invalid_argument("the function of the water's surface is empty");
}

WaterSample WaterSurfaceFunction::sample(const Vector3& point_W, double time) const noexcept {
  try {
    return function_(point_W, time);
  } catch (...) {
    return {std::numeric_limits<double>::quiet_NaN(), {0, 0, 0}, {0, 0, 0}};
  }
}

namespace {

void checkWave(const WaveComponent& wave, std::size_t index) {
  const std::string which = "of wave " + std::to_string(index);
  const InputChecks check;
  check.notNegative("amplitude [m] " + which, wave.amplitude);
  check.positive("period [s] " + which, wave.period);
  check.finite("phase [rad] " + which, wave.phase);
}

Vector3 horizontal(const Vector3& v, const Vector3& up) { return v - up.dot(v) * up; }

}  // namespace

AiryWaves::AiryWaves(const CalmSea& sea, const std::vector<WaveComponent>& components)
    : calm_(sea.level, sea.up), current_(horizontal(sea.current, calm_.up())) {
  const InputChecks check;
  check.positive("gravity of the sea [m/s^2]", sea.gravity);
  check.finite("speed of the current [m/s]", current_);
  double energy = 0, slope_squared = 0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const WaveComponent& wave = components[i];
    checkWave(wave, i);
    const Vector3 direction = horizontal(wave.direction, calm_.up());
    const double length = direction.norm();
    constexpr double kRounding = 1e-12;  // horizontal part that rounding leaves of a vertical one
    check.require(length > kRounding * wave.direction.norm() && std::isfinite(length),
                  "horizontal part of the direction of wave " + std::to_string(i), length,
                  "positive and finite");
    const double frequency = 2 * kPi / wave.period;
    const double wave_number = frequency * frequency / sea.gravity;
    // Real waves break at a slope of 0.44.
    check.require(wave.amplitude * wave_number <= 1,
                  "slope (amplitude times wave number) of wave " + std::to_string(i),
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

namespace {

constexpr int kMostComponents = 100000;

void checkSpectrum(const WaveSpectrum& s) {
  const InputChecks check{"spectrum of waves"};
  check.notNegative("significant height [m]", s.significant_height);
  check.positive("peak period [s]", s.peak_period);
  check.require(s.peak_enhancement >= 1 && std::isfinite(s.peak_enhancement), "peak enhancement",
                s.peak_enhancement, "at least 1 and finite");
  check.require(s.components >= 1 && s.components <= kMostComponents, "number of components",
                s.components, "between 1 and 100000");
}

/// omega / omega_p below which a fully developed sea has the share u of its energy; eq. (82).
double frequencyRatio(double u) { return portable::pow(-0.8 * portable::log(u), -0.25); }

/// Ratio of the JONSWAP energy density to that of a fully developed sea.
double enhancement(double gamma, double frequency_ratio) {
  const double x = frequency_ratio - 1, width = x > 0 ? 0.09 : 0.07;
  return portable::pow(gamma, portable::exp(-x * x / (2 * width * width)));
}

/// Returns u of docs/theory.md eq. (82) at the middles of parts with equal energies, by the energy
/// in equal cells of u, on which it is smooth and bounded.
std::vector<double> middlesOfEqualEnergies(double gamma, int parts) {
  constexpr std::size_t kCells = 4096;
  std::vector<double> cells(kCells);
  double total = 0;
  for (std::size_t i = 0; i < kCells; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) / kCells;
    total += cells[i] = enhancement(gamma, frequencyRatio(middle));
  }
  std::vector<double> middles;
  std::size_t cell = 0;
  double below = 0;  // energy of the cells before that
  for (int part = 0; part < parts; ++part) {
    const double energy = (part + 0.5) / parts * total;
    while (cell + 1 < kCells && below + cells[cell] < energy) below += cells[cell++];
    middles.push_back((static_cast<double>(cell) + (energy - below) / cells[cell]) / kCells);
  }
  return middles;
}

}  // namespace

std::vector<WaveComponent> wavesOf(const WaveSpectrum& spectrum) {
  checkSpectrum(spectrum);
  const double count = spectrum.components;
  // sum of a^2 / 2 = H_s^2 / 16
  const double amplitude = spectrum.significant_height / 4 * std::sqrt(2 / count);
  std::mt19937_64 bits(spectrum.seed);
  std::vector<WaveComponent> waves;
  for (const double u : middlesOfEqualEnergies(spectrum.peak_enhancement, spectrum.components)) {
    const double ratio = frequencyRatio(u);
    // Not by std::uniform_real_distribution, which differs between libraries.
    const double phase = 2 * kPi * uniformOf(bits());
    waves.push_back({amplitude, spectrum.peak_period / ratio, spectrum.direction, phase});
  }
  return waves;
}

}  // namespace ambient
