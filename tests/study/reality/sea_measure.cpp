#include "tests/study/reality/sea_measure.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

using Number = double (*)(const MotionMeasure&, const CoordinateSeries&);

double rollOf(const Quaternion& orientation) {
  const Vector3 up = orientation * Vector3::UnitZ();
  return portable::atan2(-up.y(), up.z());
}

/// Upward acceleration without that of gravity, from the velocities of two samples.
double feltBetween(const MotionSample& from, const MotionSample& to, double gravity) {
  const double change = to.twist.linear.z() - from.twist.linear.z();
  return change / (to.time - from.time) / gravity + 1;
}

struct Extreme {
  double time, value;
};

/// Vertex of the parabola through three samples at even times.
Extreme vertexAt(const CoordinateSeries& y, std::size_t i) {
  const double before = y.values[i - 1], here = y.values[i], after = y.values[i + 1];
  const double bend = before - 2 * here + after, rise = (after - before) / 2;
  const double shift = bend != 0 ? -rise / bend : 0;
  return {y.times[i] + shift * (y.times[i] - y.times[i - 1]), here + rise * shift / 2};
}

/// Extremes after the start, of alternating sign about the balance.
std::vector<Extreme> extremesOf(const MotionMeasure& what, const CoordinateSeries& y,
                                std::size_t wanted) {
  std::vector<Extreme> found;
  double side = y.values.front() - what.balance;
  for (std::size_t i = 1; i + 1 < y.values.size() && found.size() < wanted; ++i) {
    const double here = y.values[i] - what.balance;
    const bool turns = (y.values[i] - y.values[i - 1]) * (y.values[i + 1] - y.values[i]) <= 0;
    if (!turns || here * side >= 0) continue;
    found.push_back(vertexAt(y, i));
    found.back().value -= what.balance;
    side = here;
  }
  if (found.size() < wanted) throw std::runtime_error("too few extremes");
  return found;
}

double extreme(const MotionMeasure& what, const CoordinateSeries& y) {
  return extremesOf(what, y, static_cast<std::size_t>(what.count)).back().value / what.scale;
}

double timeOfExtreme(const MotionMeasure& what, const CoordinateSeries& y) {
  return extremesOf(what, y, static_cast<std::size_t>(what.count)).back().time;
}

double period(const MotionMeasure& what, const CoordinateSeries& y) {
  std::vector<double> crossings;
  for (std::size_t i = 1; i < y.values.size(); ++i) {
    const double before = y.values[i - 1] - what.balance, here = y.values[i] - what.balance;
    if (before * here >= 0) continue;
    crossings.push_back(y.times[i] - here / (here - before) * (y.times[i] - y.times[i - 1]));
  }
  const auto last = static_cast<std::size_t>(what.count);
  if (crossings.size() <= last) throw std::runtime_error("too few crossings of the balance");
  return 2 * (crossings[last] - crossings[0]) / what.count;
}

double decay(const MotionMeasure& what, const CoordinateSeries& y) {
  const auto extremes = extremesOf(what, y, static_cast<std::size_t>(what.count));
  double t = 0, l = 0, tt = 0, tl = 0;
  for (const Extreme& e : extremes) {
    const double logarithm = std::log(std::abs(e.value));
    t += e.time;
    l += logarithm;
    tt += e.time * e.time;
    tl += e.time * logarithm;
  }
  const double n = what.count;
  return -(n * tl - t * l) / (n * tt - t * t);
}

/// Two extremes a, b of an undamped swing with dw/dt = -kappa |w| w: a - b = 4/3 kappa mean^2.
double quadraticDecay(const MotionMeasure& what, const CoordinateSeries& y) {
  const auto extremes = extremesOf(what, y, static_cast<std::size_t>(what.count) + 1);
  const double a = std::abs(extremes[extremes.size() - 2].value);
  const double b = std::abs(extremes.back().value);
  return 0.75 * (a - b) / ((a + b) * (a + b) / 4) / what.scale;
}

double meanSince(double start, double balance, const CoordinateSeries& y, double power) {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < y.times.size(); ++i) {
    if (y.times[i] <= start) continue;
    sum += power == 1 ? y.values[i] - balance : (y.values[i] - balance) * (y.values[i] - balance);
    ++n;
  }
  return sum / n;
}

double mean(const MotionMeasure& what, const CoordinateSeries& y) {
  return meanSince(what.time, what.balance, y, 1) / what.scale;
}

/// Amplitude of a sine of the same variance over whole periods at the end.
double amplitude(const MotionMeasure& what, const CoordinateSeries& y) {
  const double start = y.times.back() - what.count * what.period;
  const double middle = meanSince(start, 0, y, 1);
  return std::sqrt(2 * meanSince(start, middle, y, 2)) / what.scale;
}

double largest(const MotionMeasure& what, const CoordinateSeries& y) {
  return (*std::max_element(y.values.begin(), y.values.end()) - what.balance) / what.scale;
}

double value(const MotionMeasure& what, const CoordinateSeries& y) {
  const auto after = std::lower_bound(y.times.begin(), y.times.end(), what.time);
  const std::size_t i = std::clamp<std::size_t>(static_cast<std::size_t>(after - y.times.begin()),
                                                1, y.times.size() - 1);
  const double share = (what.time - y.times[i - 1]) / (y.times[i] - y.times[i - 1]);
  return (y.values[i - 1] + share * (y.values[i] - y.values[i - 1]) - what.balance) / what.scale;
}

struct Named {
  const char* name;
  Number number;
};

constexpr Named kNumbers[] = {{"value", value},
                              {"mean", mean},
                              {"largest", largest},
                              {"extreme", extreme},
                              {"time of extreme", timeOfExtreme},
                              {"period", period},
                              {"decay", decay},
                              {"quadratic decay", quadraticDecay},
                              {"amplitude", amplitude}};

Number find(const std::string& name) {
  for (const Named& known : kNumbers)
    if (known.name == name) return known.number;
  throw std::invalid_argument("unknown number \"" + name + "\"");
}

double coordinateAt(const std::string& along, const MotionSample& sample) {
  if (along == "z") return sample.position.z();
  if (along == "roll") return rollOf(sample.orientation);
  if (along == "vx") return sample.twist.linear.x();
  if (along == "vy") return sample.twist.linear.y();
  if (along == "vz") return sample.twist.linear.z();
  throw std::invalid_argument("unknown coordinate \"" + along + "\"");
}

}  // namespace

CoordinateSeries seriesOf(const std::string& along, const std::vector<MotionSample>& motion,
                          double gravity) {
  CoordinateSeries series;
  for (std::size_t i = along == "felt" ? 1 : 0; i < motion.size(); ++i) {
    series.times.push_back(motion[i].time);
    series.values.push_back(along == "felt" ? feltBetween(motion[i - 1], motion[i], gravity)
                                            : coordinateAt(along, motion[i]));
  }
  return series;
}

MotionMeasure readMotionMeasure(const nlohmann::json& from) {
  MotionMeasure what;
  what.of = from.at("of").get<std::string>();
  find(what.of);
  what.along = from.at("along").get<std::string>();
  what.count = from.value("count", what.count);
  what.balance = from.value("balance", what.balance);
  what.scale = from.value("scale", what.scale);
  what.period = from.value("period", what.period);
  what.time = from.value("time", what.time);
  return what;
}

double measure(const MotionMeasure& what, const CoordinateSeries& series) {
  return find(what.of)(what, series);
}

}  // namespace ambient
