#include "bullet_ambient/force/medium/turbulence.h"

#include <array>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/philox.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/flow_checks.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {
namespace {

// Uses of random numbers of one seed.
enum GustStream : std::uint64_t { kDrydenPhases, kShells, kShellPhases };

RandomBlock gustNumbers(std::uint64_t seed, GustStream stream, std::size_t index) {
  return philox({index, stream, 0, 0}, {seed, 0});
}
double phaseOf(std::uint64_t bits) { return 2 * kPi * uniformOf(bits); }

// Returns the share of the energy of Dryden's spectrum below a wave number; `x`: that times the
// length. `is_along`: of the component along the wind.
double drydenShare(bool is_along, double x) {
  if (is_along) return 2 / kPi * portable::atan(x);
  return (2 * portable::atan(x) - x / (1 + x * x)) / kPi;
}

// Sum of modes whose frequencies are three to the octave: an octave on, sine and cosine are those
// of twice the angle. Components: along the wind, across it and up.
class DrydenSum {
 public:
  explicit DrydenSum(const DrydenGusts& gusts);

  FlowSample sample(double time) const noexcept;

 private:
  static constexpr int kPerOctave = 3, kMostOctaves = 17;
  static constexpr double kLowest = 1.0 / 64, kHighest = 128;  // of x

  struct Mode {
    Vector3 cosine{0, 0, 0}, sine{0, 0, 0};  // in W [m/s]
  };
  int octaves_ = 0;
  std::array<double, kPerOctave> first_{};  // frequencies [rad/s]
  std::array<std::array<Mode, kMostOctaves>, kPerOctave> modes_{};
};

DrydenSum::DrydenSum(const DrydenGusts& gusts) {
  const DrydenScales scales = drydenScales(gusts);
  const Vector3 up = gusts.up.normalized();
  Matrix3 axes;
  axes.col(0) = (gusts.direction - gusts.direction.dot(up) * up).normalized();
  axes.col(1) = up.cross(axes.col(0));
  axes.col(2) = up;
  const double lowest = kLowest / scales.lengths.maxCoeff();  // wave number [1/m]
  const double highest = kHighest / scales.lengths.minCoeff();
  while (octaves_ < kMostOctaves && std::ldexp(lowest, octaves_) < highest) ++octaves_;
  const double half = portable::exp(portable::log(2.0) / (2 * kPerOctave));  // half of a band
  double wave_number = lowest;
  for (int base = 0; base < kPerOctave; ++base, wave_number *= half * half) {
    const auto at = static_cast<std::size_t>(base);
    first_[at] = gusts.speed * wave_number;
    for (int octave = 0; octave < octaves_; ++octave) {
      const double middle = std::ldexp(wave_number, octave);
      const auto index = static_cast<std::size_t>(kPerOctave * octave + base);
      const RandomBlock numbers = gustNumbers(gusts.seed, kDrydenPhases, index);
      Mode& mode = modes_[at][static_cast<std::size_t>(octave)];
      for (int i = 0; i < 3; ++i) {
        const double x = scales.lengths[i] * middle;
        const double below = index == 0 ? 0 : drydenShare(i == 0, x / half);
        const double share = drydenShare(i == 0, x * half) - below;
        const double amplitude = scales.intensities[i] * std::sqrt(2 * share);
        const auto [sine, cosine] =
            portable::sineAndCosine(phaseOf(numbers[static_cast<std::size_t>(i)]));
        mode.cosine += amplitude * cosine * axes.col(i);
        mode.sine += amplitude * sine * axes.col(i);
      }
    }
  }
}

FlowSample DrydenSum::sample(double time) const noexcept {
  FlowSample flow;
  for (std::size_t base = 0; base < first_.size(); ++base) {
    double frequency = first_[base];
    auto [sine, cosine] = portable::sineAndCosine(frequency * time);
    for (std::size_t octave = 0; octave < static_cast<std::size_t>(octaves_); ++octave) {
      const Mode& mode = modes_[base][octave];
      flow.velocity += cosine * mode.cosine + sine * mode.sine;
      flow.acceleration += (frequency * cosine) * mode.sine - (frequency * sine) * mode.cosine;
      const double doubled = 2 * sine * cosine;
      cosine = 1 - 2 * sine * sine;
      sine = doubled;
      frequency *= 2;
    }
  }
  return flow;
}

// Energy of von Karman's spectrum at a wave number over its scale k_e, per logarithm of it [1].
double karmanDensity(double x) {
  return x * x * x * x * x / portable::pow(1 + x * x, 17.0 / 6);
}

// Waves in shells: of each shell four, along the diagonals of a turned cube, whose energies are the
// same in all directions.
class KarmanWaves {
 public:
  explicit KarmanWaves(const Turbulence& turbulence);

  FlowSample sample(const Vector3& point_W, double time) const noexcept;

 private:
  static constexpr int kShells = 16, kPerShell = 4, kWaves = kShells * kPerShell;

  struct Wave {
    Vector3 number{0, 0, 0};                 // k [1/m]
    Vector3 cosine{0, 0, 0}, sine{0, 0, 0};  // across it, of one length [m/s]
    double phase = 0;                        // at the origin at time 0 [rad]
  };
  void fillShell(int shell, double wave_number, double amplitude, std::uint64_t seed);

  Vector3 carried_;
  std::array<Wave, kWaves> waves_;
};

KarmanWaves::KarmanWaves(const Turbulence& turbulence) : carried_(turbulence.carried) {
  constexpr double kScale = 0.7468343;  // k_e L = sqrt(pi) Gamma(5/6) / Gamma(1/3)
  constexpr double kAll = 1.0325159;   // int x^4 (1 + x^2)^(-17/6) dx from 0 on
  constexpr double kFirst = -2.0794415416798357;  // log(1/8): less than 1e-4 is below
  constexpr int kParts = 64;                      // of a shell, for its energy
  const double smallest = turbulence.smallest > 0 ? turbulence.smallest : turbulence.length / 100;
  const double last = portable::log(2 * kPi * turbulence.length / (kScale * smallest));
  const double width = (last - kFirst) / kShells;
  for (int shell = 0; shell < kShells; ++shell) {
    const double begin = kFirst + shell * width;
    double energy = 0;
    for (int part = 0; part < kParts; ++part)
      energy += karmanDensity(portable::exp(begin + (part + 0.5) / kParts * width));
    energy *= width / kParts / kAll;
    fillShell(shell, kScale / turbulence.length * portable::exp(begin + width / 2),
              turbulence.intensity * std::sqrt(0.75 * energy), turbulence.seed);
  }
}

void KarmanWaves::fillShell(int shell, double wave_number, double amplitude, std::uint64_t seed) {
  const auto index = static_cast<std::size_t>(shell);
  const RandomBlock turn = gustNumbers(seed, GustStream::kShells, index);
  const RandomBlock phases = gustNumbers(seed, kShellPhases, index);
  // Attitude with a uniform distribution (Shoemake 1992).
  const double share = uniformOf(turn[0]);
  const auto a = portable::sineAndCosine(phaseOf(turn[1]));
  const auto b = portable::sineAndCosine(phaseOf(turn[2]));
  const double p = std::sqrt(1 - share), q = std::sqrt(share);
  const Quaternion attitude(q * b.cosine, p * a.sine, p * a.cosine, q * b.sine);
  for (int i = 0; i < kPerShell; ++i) {
    const Vector3 diagonal(1, i & 1 ? -1 : 1, i & 2 ? -1 : 1);
    const Vector3 along = attitude * (diagonal / std::sqrt(3.0));
    const Vector3 across = attitude * Vector3(0, 1, -diagonal.y() * diagonal.z()) / std::sqrt(2.0);
    const double hand = turn[3] >> i & 1 ? 1 : -1;
    waves_[static_cast<std::size_t>(kPerShell * shell + i)] = {
        wave_number * along, amplitude * across, hand * amplitude * along.cross(across),
        phaseOf(phases[static_cast<std::size_t>(i)])};
  }
}

FlowSample KarmanWaves::sample(const Vector3& point_W, double time) const noexcept {
  const Vector3 place = point_W - time * carried_;
  FlowSample flow;
  for (const Wave& wave : waves_) {
    const auto [sine, cosine] = portable::sineAndCosine(wave.number.dot(place) + wave.phase);
    flow.velocity += cosine * wave.cosine + sine * wave.sine;
    flow.gradient += (cosine * wave.sine - sine * wave.cosine) * wave.number.transpose();
  }
  flow.acceleration = flow.gradient * (flow.velocity - carried_);
  return flow;
}

}  // namespace

DrydenScales drydenScales(const DrydenGusts& gusts) {
  constexpr double kFoot = 0.3048, kLow = 1000, kHigh = 2000, kAloft = 1750;  // [ft]
  const double height = gusts.height / kFoot;
  if (height >= kLow) {
    const double share = std::fmin(1, (height - kLow) / (kHigh - kLow));
    const double length = kFoot * (kLow + share * (kAloft - kLow));
    return {Vector3::Constant(length), Vector3::Constant(gusts.intensity)};
  }
  const double log = portable::log(0.177 + 0.000823 * height);
  const double length = gusts.height * portable::exp(-1.2 * log);
  const double intensity = gusts.intensity * portable::exp(-0.4 * log);
  return {{length, length, gusts.height}, {intensity, intensity, gusts.intensity}};
}

FlowField drydenGusts(const DrydenGusts& gusts) {
  const FlowChecks check{"Dryden gusts"};
  check.require(gusts.height >= 3.048 && std::isfinite(gusts.height), "height [m]", gusts.height,
                "at least 3.048 and finite");
  check.require(gusts.speed > 0 && std::isfinite(gusts.speed), "speed [m/s]", gusts.speed,
                "positive and finite");
  check.require(gusts.intensity >= 0 && std::isfinite(gusts.intensity), "intensity [m/s]",
                gusts.intensity, "zero or positive and finite");
  const Vector3 up = check.direction("up", gusts.up);
  check.direction("the horizontal part of the direction",
                  gusts.direction - gusts.direction.dot(up) * up);
  return [sum = std::make_shared<const DrydenSum>(gusts)](const Vector3&, double time) {
    return sum->sample(time);
  };
}

FlowField turbulence(const Turbulence& turbulence) {
  const FlowChecks check{"turbulence"};
  check.require(turbulence.length > 0 && std::isfinite(turbulence.length), "length [m]",
                turbulence.length, "positive and finite");
  check.require(turbulence.intensity >= 0 && std::isfinite(turbulence.intensity),
                "intensity [m/s]", turbulence.intensity, "zero or positive and finite");
  check.require(turbulence.smallest >= 0 && turbulence.smallest <= turbulence.length,
                "smallest wavelength [m]", turbulence.smallest, "from 0 to the length");
  check.finite("velocity that carries it [m/s]", turbulence.carried);
  return [waves = std::make_shared<const KarmanWaves>(turbulence)](const Vector3& point_W,
                                                                   double time) {
    return waves->sample(point_W, time);
  };
}

}  // namespace ambient
