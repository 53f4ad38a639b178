#include "bullet_ambient/force/medium/turbulence.h"

#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/philox.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/input_checks.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {
namespace {

// Uses of random numbers of one seed.
enum GustStream : std::uint64_t { kGustPhases, kCubeTurns, kShellPhases };

constexpr std::size_t kShellsOfCube = 4;
constexpr double kKarmanScale = 0.7468342;  // k_e L = sqrt(pi) Gamma(5/6) / Gamma(1/3)
constexpr double kFirstShell = 0.32421;     // of k / k_e: 2e-4 of the energy is below its shell

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

// Sum of modes whose frequencies are two to the octave: an octave on, sine and cosine are those of
// twice the angle. The two modes of an octave are added up side by side.
class GustSum {
 public:
  // `axes`: those of the components, columns in W; the first `along` of them have the spectrum of
  // the component along the wind.
  GustSum(const DrydenScales& scales, double speed, const Matrix3& axes, int along,
          std::uint64_t seed)
      : axes_(axes) {
    const double lowest = kLowest / scales.lengths.maxCoeff();  // wave number [1/m]
    const double highest = kHighest / scales.lengths.minCoeff();
    const double half = std::sqrt(std::sqrt(2.0));  // of a band
    first_ = speed * lowest * Pair(1, std::sqrt(2.0));
    for (int octave = 0; std::ldexp(lowest, octave) < highest; ++octave) {
      Octave& modes = octaves_.emplace_back();
      for (int base = 0; base < kPerOctave; ++base) {
        const int index = kPerOctave * octave + base;
        const double wave_number = std::ldexp(base == 0 ? lowest : std::sqrt(2.0) * lowest, octave);
        const RandomBlock numbers = gustNumbers(seed, kGustPhases, static_cast<std::size_t>(index));
        for (int i = 0; i < 3; ++i) {
          const auto component = static_cast<std::size_t>(i);
          const double x = scales.lengths[i] * wave_number;
          const double below = index == 0 ? 0 : drydenShare(i < along, x / half);
          const double share = drydenShare(i < along, x * half) - below;
          const double amplitude = scales.intensities[i] * std::sqrt(2 * share);
          const auto [sine, cosine] = portable::sineAndCosine(phaseOf(numbers[component]));
          modes.cosine[component][base] = amplitude * cosine;
          modes.sine[component][base] = amplitude * sine;
        }
      }
    }
  }

  FlowSample sample(double time) const noexcept {
    const auto low = portable::sineAndCosine(first_[0] * time);
    const auto high = portable::sineAndCosine(first_[1] * time);
    Pair sine(low.sine, high.sine), cosine(low.cosine, high.cosine), frequency = first_;
    Eigen::Array<double, kPerOctave, 3> velocity, acceleration;
    velocity.setZero();
    acceleration.setZero();
    for (const Octave& modes : octaves_) {
      const Pair quick_sine = frequency * sine, quick_cosine = frequency * cosine;
      for (int i = 0; i < 3; ++i) {
        const Pair &c = modes.cosine[static_cast<std::size_t>(i)],
                   &s = modes.sine[static_cast<std::size_t>(i)];
        velocity.col(i) += cosine * c + sine * s;
        acceleration.col(i) += quick_cosine * s - quick_sine * c;
      }
      const Pair twice = 2 * sine;
      const Pair squared = twice * sine;
      sine = twice * cosine;
      cosine = 1 - squared;
      frequency *= 2;
    }
    const auto sumOver = [&](const auto& pairs) {
      return Vector3(axes_ * Vector3(pairs.colwise().sum().matrix().transpose()));
    };
    return {sumOver(velocity), sumOver(acceleration)};
  }

 private:
  static constexpr int kPerOctave = 2;
  static constexpr double kLowest = 1.0 / 16, kHighest = 128;  // of x

  using Pair = Eigen::Array<double, kPerOctave, 1>;
  struct Octave {
    std::array<Pair, 3> cosine, sine;  // of each component [m/s]
  };

  Matrix3 axes_;
  Pair first_;  // frequencies [rad/s]
  std::vector<Octave> octaves_;
};

// Bodies, and stations along them, ask for one time again and again: each thread keeps its last
// sample.
FlowField everywhere(GustSum gusts) {
  static std::atomic<std::uint64_t> made{0};
  return [sum = std::make_shared<const GustSum>(std::move(gusts)), number = ++made](const Vector3&,
                                                                                    double time) {
    struct Last {
      std::uint64_t number = 0;
      double time = 0;
      FlowSample sample;
    };
    thread_local Last last;
    if (last.number != number || last.time != time) last = {number, time, sum->sample(time)};
    return last.sample;
  };
}

// Energy of von Karman's spectrum at a wave number over its scale k_e, per logarithm of it [1].
double karmanDensity(double x) { return x * x * x * x * x / portable::pow(1 + x * x, 17.0 / 6); }

// Returns the share of the energy of von Karman's spectrum from x on, over a shell.
double karmanShare(double x) {
  constexpr double kAll = 1.0325159;  // int x^4 (1 + x^2)^(-17/6) dx from 0 on
  constexpr int kParts = 64;
  const double width = 0.75 * portable::log(2.0), begin = portable::log(x) - width / 2;
  double energy = 0;
  for (int part = 0; part < kParts; ++part)
    energy += karmanDensity(portable::exp(begin + (part + 0.5) / kParts * width));
  return energy * width / kParts / kAll;
}

// Waves in shells whose wave numbers are 2^(3/4) apart. Of each shell four run along the diagonals
// of a cube, with the same energies in all directions; four shells, three octaves apart, share a
// cube, and the sines and cosines of one by doubled angles.
class KarmanWaves {
 public:
  explicit KarmanWaves(const Turbulence& turbulence) : carried_(turbulence.carried) {
    const double scale = kKarmanScale / turbulence.length;  // k_e [1/m]
    const double last = 2 * kPi / turbulence.smallest;      // infinite: none
    for (int cube = 0; cube < kCubes; ++cube) {
      const double x = kFirstShell * portable::exp(0.75 * cube * portable::log(2.0));
      turnCube(cube, scale * x, turbulence.seed);
      for (std::size_t shell = 0; shell < kShellsOfCube; ++shell) {
        const double there = std::ldexp(x, 3 * static_cast<int>(shell));
        if (scale * there > last) continue;
        const double amplitude = turbulence.intensity * std::sqrt(0.75 * karmanShare(there));
        const RandomBlock phases = gustNumbers(turbulence.seed, kShellPhases,
                                               kCubes * shell + static_cast<std::size_t>(cube));
        for (std::size_t i = 0; i < phases.size(); ++i) {
          const auto [sine, cosine] = portable::sineAndCosine(phaseOf(phases[i]));
          waves_[shell][4 * static_cast<std::size_t>(cube) + i] = {amplitude * cosine,
                                                                   amplitude * sine};
        }
      }
    }
  }

  FlowSample sample(const Vector3& point_W, double time) const noexcept {
    const Vector3 place = point_W - time * carried_;
    std::array<double, kDirections> sine, cosine, number;
    for (std::size_t i = 0; i < kDirections; ++i) {
      number[i] = directions_[i].first;
      const auto at = portable::sineAndCosine(number[i] * directions_[i].along.dot(place));
      sine[i] = at.sine;
      cosine[i] = at.cosine;
    }
    // Sums over the waves along each way: velocity along e and f, and its change over the number.
    std::array<double, kDirections> by_e{}, by_f{}, change_e{}, change_f{};
    for (std::size_t shell = 0; shell < kShellsOfCube; ++shell) {
      for (std::size_t i = 0; i < kDirections; ++i) {
        const Mode& wave = waves_[shell][i];
        const double c = wave.cosine * cosine[i] - wave.sine * sine[i];
        const double s = wave.cosine * sine[i] + wave.sine * cosine[i];
        by_e[i] += c;
        by_f[i] += s;
        change_e[i] -= number[i] * s;
        change_f[i] += number[i] * c;
      }
      for (int octave = 0; octave < 3; ++octave)
        for (std::size_t i = 0; i < kDirections; ++i) {
          const double doubled = 2 * sine[i] * cosine[i];
          cosine[i] = 1 - 2 * sine[i] * sine[i];
          sine[i] = doubled;
        }
      for (double& k : number) k *= 8;
    }
    FlowSample flow;
    for (std::size_t i = 0; i < kDirections; ++i) {
      const Direction& direction = directions_[i];
      flow.velocity += by_e[i] * direction.e + by_f[i] * direction.f;
      flow.gradient +=
          (change_e[i] * direction.e + change_f[i] * direction.f) * direction.along.transpose();
    }
    flow.acceleration = flow.gradient * (flow.velocity - carried_);
    return flow;
  }

 private:
  static constexpr int kCubes = 4, kDirections = 4 * kCubes;

  struct Direction {
    Vector3 along{0, 0, 0};          // unit
    Vector3 e{0, 0, 0}, f{0, 0, 0};  // across it, unit; f = +- along x e
    double first = 0;                // wave number of its first wave [1/m]
  };
  struct Mode {
    double cosine = 0, sine = 0;  // of its phase at the origin at time 0, times its amplitude [m/s]
  };
  void turnCube(int cube, double first, std::uint64_t seed) {
    const RandomBlock turn = gustNumbers(seed, kCubeTurns, static_cast<std::size_t>(cube));
    // Attitude with a uniform distribution (Shoemake 1992).
    const double share = uniformOf(turn[0]);
    const auto a = portable::sineAndCosine(phaseOf(turn[1]));
    const auto b = portable::sineAndCosine(phaseOf(turn[2]));
    const double p = std::sqrt(1 - share), q = std::sqrt(share);
    const Quaternion attitude(q * b.cosine, p * a.sine, p * a.cosine, q * b.sine);
    for (int i = 0; i < 4; ++i) {
      const Vector3 diagonal(1, i & 1 ? -1 : 1, i & 2 ? -1 : 1);
      const int index = 4 * cube + i;
      Direction& direction = directions_[static_cast<std::size_t>(index)];
      direction.along = attitude * (diagonal / std::sqrt(3.0));
      direction.e = attitude * Vector3(0, 1, -diagonal.y() * diagonal.z()) / std::sqrt(2.0);
      direction.f = (turn[3] >> i & 1 ? 1 : -1) * direction.along.cross(direction.e);
      direction.first = first;
    }
  }

  Vector3 carried_;
  std::array<Direction, kDirections> directions_;
  std::array<std::array<Mode, kDirections>, kShellsOfCube> waves_{};
};

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
  const InputChecks check{"Dryden gusts"};
  check.require(gusts.height >= 3.048 && std::isfinite(gusts.height), "height [m]", gusts.height,
                "at least 3.048 and finite");
  check.positive("speed [m/s]", gusts.speed);
  check.notNegative("intensity [m/s]", gusts.intensity);
  const Vector3 up = check.direction("up", gusts.up);
  Matrix3 axes;
  axes.col(0) = check.direction("the horizontal part of the direction",
                                gusts.direction - gusts.direction.dot(up) * up);
  axes.col(1) = up.cross(axes.col(0));
  axes.col(2) = up;
  return everywhere({drydenScales(gusts), gusts.speed, axes, 1, gusts.seed});
}

FlowField gaussMarkovGusts(const GaussMarkovGusts& gusts) {
  const InputChecks check{"Gauss-Markov gusts"};
  for (const double sigma : gusts.intensity) check.notNegative("intensity [m/s]", sigma);
  check.positive("time [s]", gusts.time);
  return everywhere(
      {{Vector3::Constant(gusts.time), gusts.intensity}, 1, Matrix3::Identity(), 3, gusts.seed});
}

FlowField turbulence(const Turbulence& turbulence) {
  const InputChecks check{"turbulence"};
  check.positive("length [m]", turbulence.length);
  check.notNegative("intensity [m/s]", turbulence.intensity);
  check.require(turbulence.smallest >= 0 && turbulence.smallest <= turbulence.length,
                "smallest wavelength [m]", turbulence.smallest, "from 0 to the length");
  check.finite("velocity that carries it [m/s]", turbulence.carried);
  return [waves = std::make_shared<const KarmanWaves>(turbulence)](
             const Vector3& point_W, double time) { return waves->sample(point_W, time); };
}

}  // namespace ambient
