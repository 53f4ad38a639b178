#include "tests/study/reality/measured_coefficient.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"

namespace ambient {
namespace {

constexpr int kDirections = 200;

double radians(double degrees) { return degrees * kPi / 180; }

/// Direction of motion, in the plate's axes, at this incidence.
Vector3 atIncidence(double degrees) {
  return {portable::cos(radians(degrees)), 0, portable::sin(radians(degrees))};
}

double frontalArea(const FluidBody& body, const Vector3& direction) {
  if (body.sphere_radius > 0) return kPi * body.sphere_radius * body.sphere_radius;
  double area = 0;
  for (std::size_t i = 0; i < body.faces.size(); ++i)
    area += body.faces.area[i] * std::max(body.faces.normal(i).dot(direction), 0.0);
  return area;
}

/// Wind tunnel at some speed: a body in translation, or a spinning ball. Coefficients are those of
/// speed 1 times the speed squared.
class Tunnel {
 public:
  Tunnel(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law) : body_(body) {
    FlowSettings settings;
    settings.law = law;
    settings.roughness = flow.roughness;
    const Medium fluid{1, flow.length / flow.reynolds, Vector3::Zero(), Vector3::Zero()};
    loads_ = makeSurfaceLoads(std::make_shared<FluidBody>(body), fluid, settings);
  }

  void setSpeed(double speed) { speed_ = speed; }
  /// Force over half the density.
  Vector3 force(const Vector3& direction) const {
    return 2 * load({Vector3::Zero(), direction}).force;
  }
  double drag(const Vector3& direction) const { return -force(direction).dot(direction); }
  /// `twist` at speed 1.
  Wrench load(const Twist& twist) const {
    return loads_->load({speed_ * twist.angular, speed_ * twist.linear});
  }

  double meanDrag() const {
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) {  // points evenly on the sphere
      const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
      const double angle = kPi * (1 + std::sqrt(5.0)) * (i + 0.5);
      sum += drag({r * portable::cos(angle), r * portable::sin(angle), z});
    }
    return sum / kDirections / (kPi * portable::pow(3 * body_.volume / (4 * kPi), 2.0 / 3));
  }

  double stallAngle() const {
    double best = 0, largest = 0;
    for (double angle = 0.5; angle < 90; angle += 0.5) {
      const double lift = -force(atIncidence(angle)).dot(atIncidence(angle + 90));
      if (lift > largest) best = angle;
      largest = std::max(largest, lift);
    }
    return best;
  }

 private:
  const FluidBody& body_;
  double speed_ = 1;
  std::shared_ptr<const SurfaceLoads> loads_;
};

double ballCoefficient(const Tunnel& tunnel, const FluidBody& body, const MeasuredFlow& flow) {
  const double radius = body.sphere_radius, area = frontalArea(body, flow.velocity);
  const Twist twist{Vector3(0, 0, flow.spin / radius), Vector3(1, 0, 0)};
  const Wrench load = tunnel.load(twist);
  if (flow.of == "lift") return load.force.dot(Vector3(0, 1, 0)) / (0.5 * area);
  if (flow.of == "spin torque") return -load.torque.z() / (area * radius * flow.spin);
  return -load.force.x() / (0.5 * area);
}

}  // namespace

MeasuredFlow readMeasuredFlow(const nlohmann::json& flow) {
  MeasuredFlow read;
  read.of = flow.at("of").get<std::string>();
  const bool is_known = read.of == "drag" || read.of == "lift" || read.of == "normal" ||
                        read.of == "side" || read.of == "spin torque" || read.of == "stall angle";
  if (!is_known) throw std::invalid_argument("\"" + read.of + "\" is nothing that is measured");
  read.spin = flow.value("spin", 0.0);
  read.reynolds = flow.value("reynolds", read.reynolds);
  read.length = flow.value("length", read.length);
  read.roughness = flow.value("roughness", read.roughness);
  read.area = flow.value("area", read.area);
  if (flow.contains("incidence")) read.velocity = atIncidence(flow["incidence"].get<double>());
  read.is_mean = flow.contains("velocity") && flow["velocity"].is_string();
  if (flow.contains("velocity") && !read.is_mean) {
    const auto v = flow["velocity"].get<std::vector<double>>();
    read.velocity = Vector3(v.at(0), v.at(1), v.at(2)).normalized();
  }
  return read;
}

namespace {

double coefficientAt(const Tunnel& tunnel, const FluidBody& body, const MeasuredFlow& flow) {
  if (flow.of == "stall angle") return tunnel.stallAngle();
  if (body.sphere_radius > 0 && !flow.is_mean) return ballCoefficient(tunnel, body, flow);
  if (flow.is_mean) return tunnel.meanDrag();
  const Vector3 force = tunnel.force(flow.velocity), &v = flow.velocity;
  const Vector3 across(-v.z(), 0, v.x());
  const double plan = frontalArea(body, Vector3::UnitZ());
  if (flow.of == "normal") return -force.z() / plan;
  if (flow.of == "lift") return -force.dot(across) / plan;
  if (flow.of == "side") return -force.x() / (plan * v.x());
  return -force.dot(v) / (flow.area > 0 ? flow.area : frontalArea(body, v));
}

}  // namespace

double computeCoefficient(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law) {
  return coefficientAt(Tunnel(body, flow, law), body, flow);
}

double computeSettling(const FluidBody& body, const MeasuredFlow& flow, double drag,
                       PressureLaw law) {
  Tunnel tunnel(body, flow, law);
  double slow = 1e-2, fast = 1e2;
  while (fast > slow * (1 + 1e-6)) {
    const double speed = std::sqrt(slow * fast);
    tunnel.setSpeed(speed);
    (coefficientAt(tunnel, body, flow) < drag ? slow : fast) = speed;
  }
  return slow;
}

}  // namespace ambient
