#include "bullet_ambient/fluid_body/fluid_body.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/hand_over/handed_body.h"
#include "preprocess/polar/polar.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {
namespace {

namespace py = pybind11;
using FluidBodyPtr = std::shared_ptr<FluidBody>;

/// Returns loads (N, 6) for twists (N, 6), or one load (6,) for one twist (6,).
py::array_t<double> loadsFor(const BodyLoads& body_loads, const InputArray& twists) {
  const bool is_one = twists.ndim() == 1;
  if (twists.ndim() < 1 || twists.ndim() > 2 || twists.shape(twists.ndim() - 1) != 6)
    throw py::value_error("twists must be of shape (N, 6) or (6,), not " + shapeText(twists));
  const py::ssize_t count = is_one ? 1 : twists.shape(0);
  py::array_t<double> wrenches(is_one ? std::vector<py::ssize_t>{6}
                                      : std::vector<py::ssize_t>{count, 6});
  const double* from = twists.data();
  double* to = wrenches.mutable_data();
  const py::gil_scoped_release others_run;
  for (py::ssize_t i = 0; i < count; ++i) {
    const Twist twist = Twist::fromVector(Eigen::Map<const Vector6>(from + 6 * i));
    Eigen::Map<Vector6>(to + 6 * i) = body_loads.at(twist).total().vector();
  }
  return wrenches;
}

py::array_t<double> loads(const FluidBodyPtr& body, const InputArray& twists,
                          const py::object& medium, const py::object& flow) {
  return loadsFor(BodyLoads(body, mediumFrom(medium), flowFrom(flow)), twists);
}

struct PolarRow {
  double attack, side_slip, C_L, C_D, C_Y, C_l, C_m, C_n;
};

struct PolarQuestion {
  Medium medium;
  FlowSettings flow;
  PolarFlight flight;
};

PolarQuestion polarQuestion(const FluidBody& body, const py::kwargs& given) {
  const auto get = [&](const char* key, const py::object& absent) -> py::object {
    return given.contains(key) ? py::object(given[key]) : absent;
  };
  for (const auto& [key, value] : given) {
    const py::str known = "medium flow speed forward up reference_area reference_length";
    if (!known.attr("split")().contains(key))
      throw py::type_error("polar(): unknown keyword " + key.cast<std::string>() + "; known are " +
                           known.cast<std::string>());
  }
  PolarQuestion question;
  question.medium.density = 1;
  if (const py::object medium = get("medium", py::none()); !medium.is_none())
    question.medium = mediumFrom(medium);
  question.flow = flowFrom(get("flow", py::none()));
  PolarFlight& flight = question.flight;
  const auto forward = axisNamed(valueFrom<std::string>(get("forward", py::str("x")), "forward"));
  const auto up = axisNamed(valueFrom<std::string>(get("up", py::str("z")), "up"));
  if (forward.dot(up) != 0) throw py::value_error("up is along forward");
  flight.axes = flightAxes(forward, up);
  flight.density = question.medium.density;
  const auto number = [&](const char* key, double absent) {
    return valueFrom<double>(get(key, py::float_(absent)), key);
  };
  flight.speed = number("speed", 1);
  flight.reference = usualReference(body, flight.axes);
  flight.added_mass = body.added_mass.bottomRightCorner<3, 3>();
  flight.reference.area = number("reference_area", flight.reference.area);
  flight.reference.length = number("reference_length", flight.reference.length);
  if (!(flight.density > 0) || !(flight.speed > 0) || !(flight.reference.area > 0) ||
      !(flight.reference.length > 0))
    throw py::value_error("density, speed, reference_area and reference_length must be above 0");
  return question;
}

py::array_t<PolarRow> polar(const FluidBodyPtr& body, const InputArray& attack, double side_slip,
                            const py::kwargs& given) {
  const PolarQuestion question = polarQuestion(*body, given);
  const BodyLoads body_loads(body, question.medium, question.flow);
  py::array_t<PolarRow> table(attack.size());
  for (py::ssize_t i = 0; i < attack.size(); ++i) {
    if (!std::isfinite(attack.data()[i]) || !std::isfinite(side_slip))
      throw py::value_error("attack and side_slip must be finite");
    const PolarCoefficients c =
        polarCoefficients(body_loads, question.flight, attack.data()[i], side_slip);
    table.mutable_at(i) = {attack.data()[i], side_slip, c[0], c[1], c[2], c[3], c[4], c[5]};
  }
  return table;
}

template <class Column>
py::array columns(const Column& x, const Column& y, const Column& z) {
  Eigen::MatrixX3d rows(static_cast<Eigen::Index>(x.size()), 3);
  for (std::size_t i = 0; i < x.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) << x[i], y[i], z[i];
  return arrayOf(rows);
}

py::tuple massOf(const MassDistribution& mass) {
  return py::make_tuple(arrayOf(mass.centre), arrayOf(mass.inertia));
}

py::list holdsOf(const FluidBody& body) {
  py::list holds;
  for (const Hold& hold : body.holds) {
    py::dict facts;
    facts["name"] = hold.name;
    facts["volume"] = hold.volume;
    facts["centre"] = arrayOf(hold.centre);
    facts["openings"] = hold.openings.size();
    holds.append(facts);
  }
  return holds;
}

py::list wingsOf(const FluidBody& body) {
  py::list wings;
  for (const Wing& wing : body.wings) {
    py::dict facts;
    facts["name"] = wing.name;
    facts["span"] = wing.span;
    facts["chord"] = wing.chord;
    facts["thickness"] = wing.thickness;
    facts["aspect"] = wing.aspect;
    facts["body_lift"] = wing.body_lift;
    facts["joined"] = wing.is_joined;
    facts["nose"] = wing.nose;
    facts["camber"] = wing.camber;
    facts["facing"] = arrayOf(wing.facing);
    facts["span_axis"] = arrayOf(wing.span_axis);
    facts["centre"] = arrayOf(wing.centre);
    wings.append(facts);
  }
  return wings;
}

void bindParts(py::class_<FluidBody, FluidBodyPtr>& type) {
  type.def_property_readonly(
          "holds", holdsOf,
          "Rooms that stay dry: name, volume [m^3], centre (3,) in F [m], number of openings.")
      .def_property_readonly("wings", wingsOf,
                             "Parts that lift where they are, dicts as of `ambient_preprocess "
                             "inspect`; lengths in m, axes and centres (3,) in F.");
}

void bindProperties(py::class_<FluidBody, FluidBodyPtr>& type) {
  const auto get = [&type](const char* name, auto function, const char* doc) {
    type.def_property_readonly(name, function, doc);
  };
  type.def_readonly("name", &FluidBody::name, "Name in messages.")
      .def_readonly("volume", &FluidBody::volume, "Displaced volume [m^3]; a sheet has 0.")
      .def_readonly("area", &FluidBody::area, "Wetted area [m^2]; a sheet has two sides.")
      .def_readonly("sphere_radius", &FluidBody::sphere_radius,
                    "Radius of a sphere [m]; 0: no sphere.");
  get(
      "added_mass", [](const FluidBody& b) { return arrayOf(b.added_mass); },
      "Added mass (6, 6) per unit density, rotation first, in F about its origin [m^5, m^4, m^3].");
  get(
      "centre_of_volume", [](const FluidBody& b) { return arrayOf(b.centre_of_volume); },
      "Centre of volume (3,) in F [m].");
  get(
      "origin", [](const FluidBody& b) { return arrayOf(b.origin); },
      "Origin of F (3,) in the frame of the mesh [m].");
  get(
      "uniform_mass", [](const FluidBody& b) { return massOf(b.uniform_mass); },
      "Centre (3,) in F [m] and inertia (3, 3) about it [m^2] of 1 kg spread over the volume.");
  get(
      "surface_mass", [](const FluidBody& b) { return massOf(b.surface_mass); },
      "Centre (3,) in F [m] and inertia (3, 3) about it [m^2] of 1 kg spread over the area.");
  get(
      "normals",
      [](const FluidBody& b) {
        const FaceTable faces = facesOf(b);
        return columns(faces.normal_x, faces.normal_y, faces.normal_z);
      },
      "Unit normals of the faces (F, 3), into the fluid, in F.");
  get(
      "centroids",
      [](const FluidBody& b) {
        const FaceTable faces = facesOf(b);
        return columns(faces.centroid_x, faces.centroid_y, faces.centroid_z);
      },
      "Centroids of the faces (F, 3) in F [m].");
  get(
      "areas",
      [](const FluidBody& b) {
        const FaceTable faces = facesOf(b);
        return arrayOf(Eigen::Map<const Eigen::VectorXd>(
            faces.area.data(), static_cast<Eigen::Index>(faces.area.size())));
      },
      "Areas of the faces (F,) [m^2].");
  get(
      "waterline_table", [](const FluidBody& b) { return b.waterline.subdivisions; },
      "Number of divisions of the table of added mass at the surface of water; 0: no table.");
  get(
      "settings", [](const FluidBody& b) { return b.provenance.settings; },
      "Settings of its build, in words.");
  get(
      "content_hash", [](const FluidBody& b) { return contentHash(b); },
      "Hash of all data that act on the motion: equal bodies have equal hashes.");
}

// NOLINTNEXTLINE(readability-function-size): one parameter for each argument in Python
py::object exportAs(const FluidBodyPtr& body, const std::string& format_name,
                    const py::object& path, const py::object& medium, double gravity,
                    const std::optional<double>& mass, const py::object& centre_of_mass,
                    const std::string& forward, const std::string& up,
                    const std::optional<double>& draught, const std::optional<double>& speed) {
  const ExportFormat format = exportFormatOf(format_name);
  ExportSettings settings{medium.is_none() ? water() : mediumFrom(medium),
                          gravity,
                          mass,
                          std::nullopt,
                          axisNamed(forward),
                          axisNamed(up),
                          draught,
                          speed};
  if (!centre_of_mass.is_none())
    settings.centre_of_mass = vectorFrom(py::cast<InputArray>(centre_of_mass), "centre_of_mass");
  const ExportedBody made = exportFluidBody(body, format, settings);
  if (!path.is_none()) writeOrOsError([&] { made.write(pathFrom(path)); });
  return py::str(made.bytes);
}

void bindLoads(py::class_<FluidBody, FluidBodyPtr>& type) {
  type.def(
          "loads", &loads, py::arg("twists"), py::arg("medium"), py::arg("flow") = py::none(),
          R"(Computes pressure and friction of the fluid on the body, without added mass and buoyancy.

Parameters
----------
twists : (N, 6) or (6,), relative to the fluid, in F: angular velocity [rad/s], then the velocity
    of F's origin [m/s]
medium : only its density and viscosity are used
flow : settings of the flow along the surface

Returns wrenches of the same shape in F: torque about its origin [N m], then force [N]. Other
threads run meanwhile. Cost: 1.5 to 3 ns per face and twist, and per call what loads_in() costs.

>>> ball = FluidBody.from_shape({"type": "sphere", "radius": 0.1})
>>> ball.loads([0, 0, 0, 1, 0, 0], water())[3] < 0
True
)")
      .def(
          "loads_in",
          [](const FluidBodyPtr& body, const py::object& medium, const py::object& flow) {
            return BodyLoads(body, mediumFrom(medium), flowFrom(flow));
          },
          py::arg("medium"), py::arg("flow") = py::none(),
          R"(Returns loads() as a function of the twists, for many calls in one medium.

Cost: some nanoseconds per face by the published law, some microseconds by the law "form".)")
      .def("polar", &polar, py::arg("attack"), py::arg("side_slip") = 0.0,
           R"(Computes coefficients of lift, drag and moments of the body in a steady stream.

Parameters
----------
attack : angles [rad]
side_slip : [rad]
medium, speed : matter with friction only; default: density 1 without viscosity, 1 m/s
flow : FlowSettings
forward, up : axes of F with a sign; default "x", "z"
reference_area, reference_length : default: silhouette along up [m^2], extent along forward [m]

Returns a structured array: attack, side_slip [rad], C_L, C_D, C_Y, C_l, C_m, C_n about F's origin.)");
}

void bindExport(py::class_<FluidBody, FluidBodyPtr>& type) {
  type.def(
      "export", &exportAs, py::arg("format"), py::arg("path") = py::none(), py::kw_only(),
      py::arg("medium") = py::none(), py::arg("gravity") = 9.81, py::arg("mass") = py::none(),
      py::arg("centre_of_mass") = py::none(), py::arg("forward") = "x", py::arg("up") = "z",
      py::arg("draught") = py::none(), py::arg("speed") = py::none(),
      R"(Converts the body to the format of another program; docs/file_format.md lists what each format leaves out.

Parameters
----------
format : "sdf" (SDFormat, Gazebo), "mjcf" (MuJoCo) or "fossen" (JSON)
path : file that is also written, completely or not at all
medium : only its density and viscosity are used; default: water()
gravity : [m/s^2]
mass : [kg]; default: mass of the displaced fluid
centre_of_mass : (3,) in F [m]; default: centre of a mass spread evenly
forward, up : axes of F with a sign
draught : depth of the lowest point below the surface of the fluid [m]; default: no surface is near
speed : along forward [m/s], for the linearised drag of "fossen"

Returns the text of the file. Raises ValueError in one line if a number is not physical or the body
has no parts for a draught.

>>> import json
>>> ball = FluidBody.from_shape({"type": "sphere", "radius": 0.1})
>>> matrices = json.loads(ball.export("fossen"))
>>> round(matrices["M_A"][0][0] / matrices["mass"], 3)
0.5
)");
}

}  // namespace

void bindFluidBody(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(PolarRow, attack, side_slip, C_L, C_D, C_Y, C_l, C_m, C_n);
  py::class_<FluidBody, FluidBodyPtr> type(
      module, "FluidBody", R"(Data of one shape for the fluid, per unit density. Immutable.

Frame F: axes of the mesh, origin at the centre of volume unless chosen otherwise.

>>> ball = FluidBody.from_shape({"type": "sphere", "radius": 0.1})
>>> round(ball.added_mass[3, 3] / ball.volume, 3)   # a sphere carries half of what it displaces
0.5
)");
  py::class_<BodyLoads>(module, "Loads",
                        "Loads on one body in one medium; made by FluidBody.loads_in().")
      .def("__call__", &loadsFor, py::arg("twists"), "Returns the wrenches of FluidBody.loads().");
  bindProperties(type);
  bindParts(type);
  bindMakers(type);
  bindLoads(type);
  bindExport(type);
  type.def("__repr__",
           [](const FluidBody& b) {
             return "<FluidBody \"" + b.name + "\": " + std::to_string(facesOf(b).size()) +
                    " faces>";
           })
      .def(py::pickle([](const FluidBody& b) { return py::bytes(encodeFluidBody(b, b.name)); },
                      [](const py::bytes& bytes) {
                        FluidBody body = decodeFluidBody(std::string(bytes), "pickle");
                        if (!isComplete(body)) prepare(body);  // an earlier version's
                        return std::make_shared<FluidBody>(std::move(body));
                      }));
}

}  // namespace ambient
