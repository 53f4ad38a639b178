#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/hand_over/handed_body.h"
#include "preprocess/hand_over/number_text.h"
#include "preprocess/polar/polar.h"

namespace ambient {
namespace {

// SNAME's body axes in F: forward, to starboard, down.
Matrix3 bodyAxes(const HandedBody& body) {
  const Matrix3 axes = body.axes();
  Matrix3 sname;
  sname << axes.col(0), -axes.col(1), -axes.col(2);
  return sname;
}

Matrix6 inBodyAxes(const Matrix6& matrix_F, const Matrix3& axes) {
  return linearFirst(rotateAxes(matrix_F, axes.transpose()));
}

// Loads of the fluid in a steady motion, and minus their derivative by its velocities. In F,
// rotation first.
struct LinearDrag {
  Vector6 load;
  Matrix6 damping;
};

LinearDrag linearDrag(const HandedBody& body) {
  constexpr double kStep = 1e-4;  // of the speed
  const double speed = *body.settings.speed, size = std::sqrt(body.shape->area);
  const BodyLoads loads(body.shape, body.settings.medium, {});
  Vector6 motion = stack(Vector3::Zero(), speed * body.settings.forward);
  LinearDrag drag{loads.at(Twist::fromVector(motion)).total().vector(), Matrix6::Zero()};
  for (int k = 0; k < 6; ++k) {
    const double step = kStep * (k < 3 ? speed / size : speed);
    const auto loadAt = [&](double change) {
      const Vector6 moved = motion + change * Vector6::Unit(k);
      return loads.at(Twist::fromVector(moved)).total().vector();
    };
    drag.damping.col(k) = (loadAt(-step) - loadAt(step)) / (2 * step);
  }
  return drag;
}

/// Entries "key": value of one JSON object. Keys and texts have no letters to be escaped.
class JsonObject {
 public:
  void text(const char* key, const std::string& value) { add(key, "\"" + value + "\""); }
  void number(const char* key, double value) { add(key, numberText(value)); }
  template <class Vector>
  void row(const char* key, const Vector& value) {
    add(key, "[" + rowText(value, ", ") + "]");
  }
  template <class Matrix>
  void matrix(const char* key, const Matrix& value) {
    std::string rows;
    for (Eigen::Index i = 0; i < value.rows(); ++i)
      rows += (i > 0 ? ",\n    [" : "\n    [") + rowText(value.row(i), ", ") + "]";
    add(key, "[" + rows + "\n  ]");
  }
  std::string finished() const { return "{\n" + entries_ + "\n}\n"; }

 private:
  void add(const std::string& key, const std::string& value) {
    entries_ += (entries_.empty() ? "  \"" : ",\n  \"") + key + "\": " + value;
  }
  std::string entries_;
};

void addHydrostatics(JsonObject& json, const HandedBody& body, const Matrix3& axes) {
  if (body.settings.draught) json.number("draught", *body.settings.draught);
  json.number("displaced_volume", body.wet.volume);
  if (body.wet.volume > 0)
    json.row("centre_of_buoyancy", Vector3(axes.transpose() * body.middle()));
  json.number("waterplane_area", body.wet.waterplane.area);
  json.matrix(
      "G",
      inBodyAxes(restoringStiffness(body.wet, body.plane, body.weight, Vector3::Zero()), axes));
}

void addDrag(JsonObject& json, const HandedBody& body, const Matrix3& axes) {
  const LinearDrag drag = linearDrag(body);
  const double speed = *body.settings.speed;
  // Loads of a sphere are 0 beyond that.
  const bool has_pressure = std::isfinite(body.settings.medium.density * speed * speed);
  if (!has_pressure || !drag.load.allFinite() || !drag.damping.allFinite())
    reject(*body.shape, "speed [m/s]", speed, "small enough for a finite drag");
  Vector6 load;
  load << axes.transpose() * drag.load.tail<3>(), axes.transpose() * drag.load.head<3>();
  json.number("speed", speed);
  json.matrix("D", inBodyAxes(drag.damping, axes));
  json.row("tau", load);
}

}  // namespace

ExportedBody makeFossen(const HandedBody& body) {
  const Matrix3 axes = bodyAxes(body);
  JsonObject json;
  json.text("name", body.name);
  json.text("frame",
            "body axes of SNAME: x forward, y to starboard, z down; origin: that of the .ambient "
            "file");
  json.text("order", "u v w p q r");
  json.number("density", body.settings.medium.density);
  json.number("gravity", body.settings.gravity);
  json.number("mass", body.weight.mass);
  json.row("centre_of_gravity", Vector3(axes.transpose() * body.weight.centre));
  json.matrix("M_RB", inBodyAxes(body.ownInertia(), axes));
  json.matrix("M_A", inBodyAxes(body.added_mass, axes));
  addHydrostatics(json, body, axes);
  if (body.settings.speed) addDrag(json, body, axes);
  return {json.finished(), ""};
}

}  // namespace ambient
