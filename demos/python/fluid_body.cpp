#include "bullet_ambient/fluid_body/fluid_body.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "bullet_ambient/fluid_body/content_hash.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/python/fluid_body_export.h"
#include "demos/python/fluid_body_sources.h"
#include "preprocess/polar/polar.h"

namespace ambient {
namespace {

namespace py = pybind11;
using FluidBodyPtr = std::shared_ptr<FluidBody>;

/// Vertices (V, 3) and faces (F, 3) of a mesh object of several libraries, or of two arrays.
std::pair<InputArray, py::array_t<std::int64_t>> meshArrays(const py::object& mesh,
                                                            const py::object& faces) {
  const auto arrays = [](const py::object& vertices, const py::object& triangles) {
    using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
    return std::make_pair(vertices.cast<InputArray>(),
                          py::array_t<std::int64_t>(triangles.cast<Indices>()));
  };
  if (!faces.is_none()) return arrays(mesh, faces);
  if (py::hasattr(mesh, "vertices") && py::hasattr(mesh, "faces"))
    return arrays(mesh.attr("vertices"), mesh.attr("faces"));
  if (py::hasattr(mesh, "points") && py::hasattr(mesh, "cells_dict")) {
    // meshio has names as keys, pyvista has VTK's cell types: 5 is a triangle.
    const py::dict cells = mesh.attr("cells_dict");
    if (cells.contains("triangle")) return arrays(mesh.attr("points"), cells["triangle"]);
    if (cells.contains(py::int_(5))) return arrays(mesh.attr("points"), cells[py::int_(5)]);
  }
  throw py::type_error(
      "a mesh must have .vertices and .faces, or .points and .cells_dict with triangles; or give "
      "two arrays");
}

TriangleMesh meshFrom(const py::object& mesh, const py::object& faces) {
  const auto [vertices, triangles] = meshArrays(mesh, faces);
  if (vertices.ndim() != 2 || vertices.shape(1) != 3)
    throw py::value_error("vertices must be of shape (V, 3), not " + shapeText(vertices));
  if (triangles.ndim() != 2 || triangles.shape(1) != 3)
    throw py::value_error("faces must be of shape (F, 3), not " + shapeText(triangles));
  TriangleMesh made;
  made.vertices = Eigen::Map<const Eigen::Matrix3Xd>(vertices.data(), 3, vertices.shape(0));
  made.triangles = Eigen::Map<const Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>>(
                       triangles.data(), 3, triangles.shape(0))
                       .cast<int>();
  return made;
}

SourceSettings settingsFrom(const std::string& name, const py::kwargs& given) {
  SourceSettings settings;
  settings.name = name;
  for (const auto& [key, value] : given) {
    const auto word = key.cast<std::string>();
    if (value.is_none()) continue;
    if (word == "origin")
      settings.origin = vectorFrom(py::cast<InputArray>(value), word);
    else if (word == "panels")
      settings.flow.max_panels = value.cast<int>();
    else if (word == "threads")
      settings.flow.threads = value.cast<int>();
    else if (word == "waterline_table")
      settings.waterline_subdivisions = value.cast<int>();
    else if (word == "cache")
      settings.cache = pathFrom(py::reinterpret_borrow<py::object>(value));
    else
      throw py::type_error("unknown keyword " + word +
                           "; known are origin, panels, threads, waterline_table, cache");
  }
  return settings;
}

/// Builds while other threads of Python run; issues the warnings of the build as Python warnings.
template <class Make>
FluidBodyPtr build(const Make& make) {
  BuiltBody built;
  {
    const py::gil_scoped_release others_run;
    built = make();
  }
  for (const std::string& warning : built.warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 2) != 0) throw py::error_already_set();
  return std::make_shared<FluidBody>(std::move(built.body));
}

FluidBodyPtr fromMesh(const py::object& mesh, const py::object& faces, bool sheet,
                      const std::string& name, const py::kwargs& given) {
  const TriangleMesh triangles = meshFrom(mesh, faces);
  const SourceSettings settings = settingsFrom(name, given);
  return build([&] { return buildFromMesh(triangles, sheet, settings); });
}

FluidBodyPtr fromShape(const py::object& shape, const std::string& name, const py::object& folder,
                       const py::kwargs& given) {
  const std::string json = jsonFrom(shape);
  const std::filesystem::path where = pathFrom(folder);
  const SourceSettings settings = settingsFrom(name, given);
  return build([&] { return buildFromShape(json, where, settings); });
}

FluidBodyPtr read(const py::object& path) {
  const std::filesystem::path file = pathFrom(path);
  requireReadable(file);
  return std::make_shared<FluidBody>(readFluidBody(file));
}

void write(const FluidBody& body, const py::object& path) {
  writeOrOsError([&] { writeFluidBody(body, pathFrom(path)); });
}

/// Loads (N, 6) for twists (N, 6), or one load for one twist.
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

py::array_t<double> loads(const FluidBodyPtr& body, const InputArray& twists, const Medium& medium,
                          const FlowSettings& flow) {
  return loadsFor(BodyLoads(body, medium, flow), twists);
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
  question.medium =
      get("medium", py::cast(Medium{1, 0, Vector3::Zero(), Vector3::Zero()})).cast<Medium>();
  question.flow = get("flow", py::cast(FlowSettings())).cast<FlowSettings>();
  PolarFlight& flight = question.flight;
  const auto forward = axisNamed(get("forward", py::str("x")).cast<std::string>());
  const auto up = axisNamed(get("up", py::str("z")).cast<std::string>());
  if (forward.dot(up) != 0) throw py::value_error("up is along forward");
  flight.axes = flightAxes(forward, up);
  flight.density = question.medium.density;
  flight.speed = get("speed", py::float_(1.0)).cast<double>();
  flight.reference = usualReference(body, flight.axes);
  flight.reference.area = get("reference_area", py::float_(flight.reference.area)).cast<double>();
  flight.reference.length =
      get("reference_length", py::float_(flight.reference.length)).cast<double>();
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

void bindProperties(py::class_<FluidBody, FluidBodyPtr>& type) {
  const auto get = [&type](const char* name, auto function, const char* doc) {
    type.def_property_readonly(name, function, doc);
  };
  type.def_readonly("name", &FluidBody::name, "For messages.")
      .def_readonly("volume", &FluidBody::volume, "Displaced volume [m^3]; 0 of a sheet.")
      .def_readonly("area", &FluidBody::area, "Wetted area [m^2]; both sides of a sheet.")
      .def_readonly("sphere_radius", &FluidBody::sphere_radius, "[m]; 0: not a sphere.");
  get(
      "added_mass", [](const FluidBody& b) { return arrayOf(b.added_mass); },
      "(6, 6), rotation first, about F's origin in F, per unit density [kg per kg/m^3, with m, "
      "m^2].");
  get(
      "centre_of_volume", [](const FluidBody& b) { return arrayOf(b.centre_of_volume); },
      "(3,) in F [m].");
  get(
      "origin", [](const FluidBody& b) { return arrayOf(b.origin); },
      "(3,), of F in the frame of the mesh [m].");
  get(
      "uniform_mass", [](const FluidBody& b) { return massOf(b.uniform_mass); },
      "Centre (3,) in F [m] and inertia (3, 3) about it [m^2] of 1 kg spread over the volume.");
  get(
      "surface_mass", [](const FluidBody& b) { return massOf(b.surface_mass); },
      "The same of 1 kg spread over the area.");
  get(
      "normals",
      [](const FluidBody& b) {
        return columns(b.faces.normal_x, b.faces.normal_y, b.faces.normal_z);
      },
      "(F, 3), of the faces, into the fluid, in F.");
  get(
      "centroids",
      [](const FluidBody& b) {
        return columns(b.faces.centroid_x, b.faces.centroid_y, b.faces.centroid_z);
      },
      "(F, 3), of the faces, in F [m].");
  get(
      "areas",
      [](const FluidBody& b) {
        return arrayOf(Eigen::Map<const Eigen::VectorXd>(
            b.faces.area.data(), static_cast<Eigen::Index>(b.faces.area.size())));
      },
      "(F,), of the faces [m^2].");
  get(
      "waterline_table", [](const FluidBody& b) { return b.waterline.subdivisions; },
      "Divisions of its table for the surface of water; 0: none.");
  get(
      "settings", [](const FluidBody& b) { return b.provenance.settings; },
      "How it was made, in words.");
  get(
      "content_hash", [](const FluidBody& b) { return contentHash(b); },
      "Of all that acts on the motion: equal bodies have equal hashes.");
}

void bindMakers(py::class_<FluidBody, FluidBodyPtr>& type) {
  type.def_static("from_mesh", &fromMesh, py::arg("mesh"), py::arg("faces") = py::none(),
                  py::kw_only(), py::arg("sheet") = false, py::arg("name") = "mesh",
                  R"(Solves the flow around a closed mesh, or an open sheet.

Parameters
----------
mesh : anything with .vertices and .faces, or .points and .cells_dict, or vertices (V, 3) [m]
faces : (F, 3) indices, counter-clockwise seen from the fluid, if `mesh` is an array
sheet : an open surface of zero thickness
name : for messages
origin : (3,) of F in the mesh's frame [m]; default: the centre of volume
panels : into which the flow's surface is divided at most; default 4200, 0: the faces
threads : 0 (default): all cores; the result does not depend on it
waterline_table : N, 1 to 16: makes a table of the added mass at the surface of water, for N divisions
    of the octahedron of attitudes, in half a minute and more; default 0: none
cache : a folder that keeps what was solved, by content

Raises ValueError in one line if the mesh is open, crosses itself or is otherwise no body.
Cost: a second or two for a thousand faces.)")
      .def_static("from_shape", &fromShape, py::arg("shape"), py::kw_only(),
                  py::arg("name") = "shape", py::arg("folder") = ".",
                  R"(From a shape as scenes describe it: {"type": "box", "size": [1, 2, 3]}.

`folder` is where relative file names begin; origin, panels, threads, waterline_table and cache as in from_mesh().)")
      .def_static("read", &read, py::arg("path"), "Reads an .ambient file.")
      .def("write", &write, py::arg("path"), "Writes an .ambient file: the old one or the new one.")
      .def(
          "scaled",
          [](const FluidBody& body, double factor) {
            return std::make_shared<FluidBody>(scaled(body, factor));
          },
          py::arg("factor"), "The same shape, `factor` times as large about F's origin.");
}

void bindLoads(py::class_<FluidBody, FluidBodyPtr>& type) {
  type.def("loads", &loads, py::arg("twists"), py::arg("medium"), py::arg("flow") = FlowSettings(),
           R"(Pressure and friction of the fluid on the body, without added mass and buoyancy.

Parameters
----------
twists : (N, 6) or (6,), relative to the fluid, in F: angular velocity [rad/s], then the velocity
    of F's origin [m/s]
medium : density and viscosity count
flow : how the flow follows the surface

Returns wrenches of the same shape in F: torque about its origin [N m], then force [N]. Other
threads run meanwhile. Cost: 1.5 to 3 ns per face and twist, and per call what loads_in() costs.

>>> ball = FluidBody.from_shape({"type": "sphere", "radius": 0.1})
>>> ball.loads([0, 0, 0, 1, 0, 0], water())[3] < 0
True
)")
      .def(
          "loads_in",
          [](const FluidBodyPtr& body, const Medium& medium, const FlowSettings& flow) {
            return BodyLoads(body, medium, flow);
          },
          py::arg("medium"), py::arg("flow") = FlowSettings(),
          R"(The same as a function of the twists, for many calls.

Cost: some nanoseconds per face by the published law, some microseconds by the law "form".)")
      .def("polar", &polar, py::arg("attack"), py::arg("side_slip") = 0.0,
           R"(Coefficients of lift, drag and moments of the body in a steady stream.

Parameters
----------
attack : angles [rad]
side_slip : [rad]
medium, speed : matter where there is friction; default density 1 without it, 1 m/s
flow : FlowSettings
forward, up : axes of F with a sign; default "x", "z"
reference_area, reference_length : default: silhouette along up [m^2], extent along forward [m]

Returns a structured array: attack, side_slip [rad], C_L, C_D, C_Y, C_l, C_m, C_n about F's origin.)");
}

}  // namespace

void bindFluidBody(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(PolarRow, attack, side_slip, C_L, C_D, C_Y, C_l, C_m, C_n);
  py::class_<FluidBody, FluidBodyPtr> type(
      module, "FluidBody", R"(What the fluid needs to know of one shape, per unit density.

Frame F: the axes of the mesh, its origin at the centre of volume unless chosen otherwise. Never changes.

>>> ball = FluidBody.from_shape({"type": "sphere", "radius": 0.1})
>>> round(ball.added_mass[3, 3] / ball.volume, 3)   # a sphere carries half of what it displaces
0.5
)");
  py::class_<BodyLoads>(module, "Loads", "What FluidBody.loads_in() gives.")
      .def("__call__", &loadsFor, py::arg("twists"), "Wrenches as of FluidBody.loads().");
  bindProperties(type);
  bindMakers(type);
  bindLoads(type);
  bindExport(type);
  type.def("__repr__",
           [](const FluidBody& b) {
             return "<FluidBody \"" + b.name + "\": " + std::to_string(b.faces.size()) + " faces>";
           })
      .def(py::pickle([](const FluidBody& b) { return py::bytes(encodeFluidBody(b, b.name)); },
                      [](const py::bytes& bytes) {
                        return std::make_shared<FluidBody>(
                            decodeFluidBody(std::string(bytes), "pickle"));
                      }));
}

}  // namespace ambient
