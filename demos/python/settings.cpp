#include <pybind11/stl.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/wind.h"
#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/scene/scene_flows.h"
#include "demos/scene/scene_parts.h"
#include "preprocess/shape/json_schema.h"

namespace ambient {
namespace {

namespace py = pybind11;

/// A class of bullet_ambient/settings.py.
py::object settingsClass(const char* name) {
  return py::module_::import("bullet_ambient.settings").attr(name);
}

void requireClass(const py::object& settings, const char* name) {
  if (!py::isinstance(settings, settingsClass(name)))
    throw py::type_error(py::repr(settings).cast<std::string>() + " is no " + name);
}

void refuse(const char* who, const std::optional<NumberFault>& fault) {
  if (!fault) return;
  std::ostringstream sentence;
  sentence << who << fault->quantity << " [" << fault->unit << "] is " << fault->value
           << "; must be " << fault->limit;
  throw std::invalid_argument(sentence.str());
}

template <class Value>
Value member(const py::object& settings, const char* name) {
  return valueFrom<Value>(settings.attr(name), name);
}

Vector3 vectorAt(const py::object& settings, const char* name) {
  const auto numbers = settings.attr(name).cast<std::array<double, 3>>();
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

Medium mediumFrom(const py::object& settings) {
  requireClass(settings, "Medium");
  const Medium medium{member<double>(settings, "density"), member<double>(settings, "viscosity"),
                      vectorAt(settings, "velocity"), vectorAt(settings, "acceleration")};
  refuse("Medium: ", faultOf(medium));
  return medium;
}

FlowSettings flowFrom(const py::object& settings) {
  FlowSettings flow;
  if (settings.is_none()) return flow;
  requireClass(settings, "FlowSettings");
  const auto word = member<std::string>(settings, "law");
  const auto law = valueOf(kPressureLawNames, word);
  if (!law) throw std::invalid_argument("law is \"" + word + "\"; must be form or published");
  flow.law = *law;
  flow.separation_angle = member<double>(settings, "separation_angle");
  flow.roughness = member<double>(settings, "roughness");
  flow.skin_friction = member<bool>(settings, "skin_friction");
  flow.maximum_load_error = member<double>(settings, "maximum_load_error");
  flow.stall_lag = member<double>(settings, "stall_lag");
  refuse("FlowSettings: ", faultOf(flow));
  return flow;
}

py::object toPython(const Medium& medium) {
  const auto tuple = [](const Vector3& v) { return py::make_tuple(v.x(), v.y(), v.z()); };
  return settingsClass("Medium")(py::arg("density") = medium.density,
                                 py::arg("viscosity") = medium.viscosity,
                                 py::arg("velocity") = tuple(medium.velocity),
                                 py::arg("acceleration") = tuple(medium.acceleration));
}

namespace {

// Velocities of a flow of a scene at points (N, 3) and a time.
py::array velocitiesOf(const std::string& flow, const InputArray& points, double time,
                       const InputArray& up) {
  nlohmann::json schema{{"$ref", "#/definitions/flow"}};
  schema["definitions"] = sceneSchema().document().at("definitions");
  const nlohmann::json from = parseJson(flow, "flow");
  JsonSchema(schema, "flow").check(from, "flow");
  if (points.ndim() != 2 || points.shape(1) != 3)
    throw py::value_error("points must be an array (N, 3)");
  const FlowField field = toFlow(from, vectorFrom(up, "up"));
  py::array_t<double> velocities({points.shape(0), points.shape(1)});
  const double* at = points.data();
  double* to = velocities.mutable_data();
  for (py::ssize_t i = 0; field && i < points.shape(0); ++i)
    Eigen::Map<Vector3>(to + 3 * i) = field(Eigen::Map<const Vector3>(at + 3 * i), time).velocity;
  return velocities;
}

}  // namespace

void bindSettings(py::module_& module) {
  module.def("_check_medium", [](const py::object& settings) { mediumFrom(settings); });
  module.def("_check_flow", [](const py::object& settings) { flowFrom(settings); });
  module.def("_standard_atmosphere",
             [](double height) { return toPython(standardAtmosphere(height)); });
  module.def("_flow_velocity", &velocitiesOf, py::arg("flow"), py::arg("points"), py::arg("time"),
             py::arg("up"));
  module.def(
      "air", [] { return toPython(air()); }, "Returns air at 20 C and sea level.");
  module.def(
      "water", [] { return toPython(water()); }, "Returns fresh water at 20 C.");
}

}  // namespace ambient
