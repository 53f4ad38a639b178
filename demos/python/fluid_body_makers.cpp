#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {
namespace {

namespace py = pybind11;
using FluidBodyPtr = std::shared_ptr<FluidBody>;

using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Settings for building a fluid body in Python.
struct SourceSettings : CommonBuildSettings {
  BodyFolder cache;            ///< default: none
  bool strict = false;         ///< refuse a mesh that is not a closed body, in place of wrapping it
  std::string wings = "none";  ///< as ShapeBuildSettings::wings
};

namespace fs = std::filesystem;

/// Returns the fluid body from the cache if its provenance agrees, else the result of `build`.
template <class Build>
FluidBody buildOnce(const SourceSettings& settings, const Provenance& provenance,
                    const Build& build) {
  BodyMaker maker(settings.cache, printReport);
  const BodyMaker::Made made = maker.get(settings.name, provenance, build);
  maker.keep(made);
  return *made.body;
}

template <class Matrix>
std::string_view bytesOf(const Matrix& matrix) {
  return {reinterpret_cast<const char*>(matrix.data()),
          static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar)};
}

Provenance provenanceOf(const TriangleMesh& mesh, bool sheet, const SourceSettings& settings) {
  std::ostringstream text;
  text.precision(17);
  text << (sheet ? "sheet" : "body") << ", origin ";
  if (settings.origin)
    text << settings.origin->x() << "," << settings.origin->y() << "," << settings.origin->z();
  else
    text << "centre-of-volume";
  text << ", panels " << settings.flow.max_panels;
  if (settings.waterline_subdivisions != 0)
    text << ", waterline " << settings.waterline_subdivisions;
  if (settings.strict) text << ", strict";
  if (!sheet) text << holdsText(settings.holds);
  text << wingsText(settings.wings);
  Provenance provenance;
  provenance.source = "arrays";
  provenance.source_hash =
      fnv1a64(std::string(bytesOf(mesh.vertices)) + std::string(bytesOf(mesh.triangles)));
  provenance.settings = text.str();
  provenance.generator = libraryVersion();
  return provenance;
}

/// Builds a fluid body of a mesh in memory; `sheet`: the mesh is a sheet of zero thickness.
/// @throws std::runtime_error in one line that begins with settings.name
FluidBody buildFromMesh(const TriangleMesh& mesh, bool sheet, const SourceSettings& settings) {
  BuildSettings build;
  static_cast<CommonBuildSettings&>(build) = settings;
  build.flow.sheet = sheet;
  build.provenance = provenanceOf(mesh, sheet, settings);
  return buildOnce(settings, build.provenance, [&](const auto& begin) {
    build.begin = begin;
    CheckedMesh checked = sheet ? requireSound(checkMesh(mesh, settings.name, true), settings.name)
                                : makeBodyMesh(mesh, settings.name, settings.strict);
    build.cavities = checked.cavities;
    if (sheet && !(settings.holds.tanks.empty() && settings.holds.openings.empty()))
      throw std::runtime_error(settings.name + ": a tank or an opening needs a closed mesh");
    if (!sheet) {
      const std::vector<std::string> lines = takeHolds(checked.mesh, build);
      checked.warnings.insert(checked.warnings.end(), lines.begin(), lines.end());
      ShapeDescription arrays;
      arrays.source = settings.name;
      build.wings = planWings(settings.wings, checked.mesh, arrays, 1);
    }
    build.warn = [&](const std::string& text) { checked.warnings.push_back(text); };
    FluidBody body = makeFluidBody(checked.mesh, build);
    body.provenance.said = std::move(checked.warnings);
    return body;
  });
}

/// Builds a fluid body of a shape in JSON, see shape.schema.json. Relative paths of files are
/// relative to `folder`. @throws std::runtime_error as buildShape().
FluidBody buildFromShape(const std::string& json, const fs::path& folder,
                         const SourceSettings& settings) {
  ShapeDescription shape = readShape(parseJson(json, settings.name), folder, settings.name);
  if (auto* mesh = std::get_if<MeshFile>(&shape.geometry))
    mesh->strict = mesh->strict || settings.strict;
  ShapeBuildSettings build;
  static_cast<CommonBuildSettings&>(build) = settings;
  build.wings = settings.wings;
  if (std::holds_alternative<FluidBodyFile>(shape.geometry)) return buildShape(shape, build).body;
  return buildOnce(settings, describeShape(shape, build), [&](const auto& begin) {
    build.begin = begin;
    return buildShape(shape, build).body;
  });
}

/// Returns the indices of vertices that the faces have. Throws TypeError for numbers that are not
/// integers, which the conversion would cut.
Indices indicesFrom(const py::object& faces) {
  const auto given = py::array::ensure(faces);
  if (!given) throw py::error_already_set();
  const char kind = given.dtype().kind();
  if (kind != 'i' && kind != 'u' && given.size() > 0)
    throw py::type_error("faces must be integers, not " +
                         py::str(given.dtype()).cast<std::string>());
  return given.cast<Indices>();
}

/// Returns vertices (V, 3) and faces (F, 3) of a mesh object of one of several libraries, or of two
/// arrays.
std::pair<InputArray, Indices> meshArrays(const py::object& mesh, const py::object& faces) {
  const auto arrays = [](const py::object& vertices, const py::object& triangles) {
    return std::make_pair(vertices.cast<InputArray>(), indicesFrom(triangles));
  };
  if (!faces.is_none()) return arrays(mesh, faces);
  if (py::hasattr(mesh, "vertices") && py::hasattr(mesh, "faces"))
    return arrays(mesh.attr("vertices"), mesh.attr("faces"));
  if (py::hasattr(mesh, "points") && py::hasattr(mesh, "cells_dict")) {
    // Keys of cells: names with meshio, VTK's cell types with pyvista, where 5 is a triangle.
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
  const std::int64_t* const end = triangles.data() + triangles.size();
  const auto wrong =
      std::find_if(triangles.data(), end, [](std::int64_t i) { return i != static_cast<int>(i); });
  if (wrong != end)
    throw py::value_error("faces refer to vertex " + std::to_string(*wrong) + ", but there are " +
                          std::to_string(vertices.shape(0)) + " vertices");
  TriangleMesh made;
  made.vertices = Eigen::Map<const Eigen::Matrix3Xd>(vertices.data(), 3, vertices.shape(0));
  made.triangles = Eigen::Map<const Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>>(
                       triangles.data(), 3, triangles.shape(0))
                       .cast<int>();
  return made;
}

bool holdsWanted(const py::handle& given) {
  const std::string word = py::isinstance<py::str>(given) ? given.cast<std::string>() : "";
  if (word != "auto" && word != "none")
    throw py::value_error("holds must be \"auto\" or \"none\", not " +
                          py::repr(given).cast<std::string>());
  return word == "auto";
}

/// "none", "auto" or a file that lists them.
std::string wingsWanted(const py::handle& given) {
  const auto word = py::str(given).cast<std::string>();
  if (word == "auto" || word == "none") return word;
  const fs::path file = pathFrom(py::reinterpret_borrow<py::object>(given));
  requireReadable(file);
  return file.string();
}

std::vector<fs::path> tanksFrom(const py::handle& given) {
  if (py::isinstance<py::str>(given) || !py::isinstance<py::sequence>(given))
    throw py::value_error("tanks must be a list of files");
  std::vector<fs::path> tanks;
  for (const py::handle& file : py::reinterpret_borrow<py::sequence>(given))
    tanks.push_back(pathFrom(py::reinterpret_borrow<py::object>(file)));
  return tanks;
}

std::vector<GivenOpening> openingsFrom(const py::handle& given) {
  const auto refuse = [] {
    throw py::value_error("openings must be a list of (place, normal, area): (3,), (3,), a number");
  };
  if (py::isinstance<py::str>(given) || !py::isinstance<py::sequence>(given)) refuse();
  std::vector<GivenOpening> openings;
  for (const py::handle& opening : py::reinterpret_borrow<py::sequence>(given)) {
    if (!py::isinstance<py::sequence>(opening) || py::len(opening) != 3) refuse();
    const auto parts = py::reinterpret_borrow<py::sequence>(opening);
    if (!PyNumber_Check(py::object(parts[2]).ptr())) refuse();
    openings.push_back({vectorFrom(py::cast<InputArray>(parts[0]), "place of an opening"),
                        vectorFrom(py::cast<InputArray>(parts[1]), "normal of an opening"),
                        py::float_(parts[2])});
  }
  return openings;
}

Vector3 directionFrom(const InputArray& array, const std::string& what) {
  const Vector3 direction = vectorFrom(array, what);
  if (!direction.allFinite() || direction.isZero(0))
    throw py::value_error(what + " must be a direction: finite, and not zero");
  return direction.stableNormalized();
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
      settings.flow.max_panels = valueFrom<int>(value, word);
    else if (word == "threads")
      settings.flow.threads = valueFrom<int>(value, word);
    else if (word == "waterline_table")
      settings.waterline_subdivisions = valueFrom<int>(value, word);
    else if (word == "holds")
      settings.holds.is_wanted = holdsWanted(value);
    else if (word == "wings")
      settings.wings = wingsWanted(value);
    else if (word == "tanks")
      settings.holds.tanks = tanksFrom(value);
    else if (word == "openings")
      settings.holds.openings = openingsFrom(value);
    else if (word == "up")
      settings.holds.up = directionFrom(py::cast<InputArray>(value), word);
    else if (word == "strict")
      settings.strict = valueFrom<bool>(value, word);
    else if (word == "cache")
      settings.cache = pathFrom(py::reinterpret_borrow<py::object>(value));
    else
      throw py::type_error("unknown keyword " + word +
                           "; known are origin, panels, threads, waterline_table, holds, up, "
                           "tanks, openings, wings, strict, cache");
  }
  return settings;
}

/// Calls `make` without the interpreter's lock, so that other threads of Python run. Issues the
/// warnings of the build as Python warnings.
template <class Make>
FluidBodyPtr build(const Make& make) {
  FluidBody built;
  {
    const py::gil_scoped_release others_run;
    built = make();
  }
  for (const std::string& warning : built.provenance.said)
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 2) != 0) throw py::error_already_set();
  return std::make_shared<FluidBody>(std::move(built));
}

FluidBodyPtr fromMesh(const py::object& mesh, const py::object& faces, bool sheet,
                      const std::string& name, const py::kwargs& given) {
  const TriangleMesh triangles = meshFrom(mesh, faces);
  const SourceSettings settings = settingsFrom(name, given);
  return build([&] { return buildFromMesh(triangles, sheet, settings); });
}

FluidBodyPtr fromShape(const py::object& shape, const std::string& name, const py::object& folder,
                       const py::kwargs& given) {
  const std::string json = jsonFrom(shape, name + ": ");
  const std::filesystem::path where = pathFrom(folder);
  const SourceSettings settings = settingsFrom(name, given);
  return build([&] { return buildFromShape(json, where, settings); });
}

FluidBodyPtr read(const py::object& path) {
  const std::filesystem::path file = pathFrom(path);
  requireReadable(file);
  return std::make_shared<FluidBody>(readPrepared(file));
}

void write(const FluidBody& body, const py::object& path) {
  writeOrOsError([&] { writeFluidBody(body, pathFrom(path)); });
}

}  // namespace

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
origin : (3,) origin of F in the mesh's frame [m]; default: the centre of volume
panels : largest number of panels for the flow; default 4200; 0: the faces of the mesh
threads : number of threads; 0 (default): all cores; the result does not depend on it
waterline_table : N from 1 to 16: also computes a table of the added mass at the surface of water, for
    N divisions of the octahedron of attitudes, which takes half a minute and more; default 0: none
holds : "auto" (default): rooms that hold water stay dry, with a warning that names them; "none": the body of its walls
up : (3,) which way the mesh stands when its holds are found; default: the axis with the largest ones
tanks : files of closed meshes in the walls or in a cavity that are holds without openings
openings : list of (place (3,) [m], normal (3,) out of the hold, area [m^2]): holes in the nearest wall of a hold
wings : "none" (default): one lift for the whole body; "auto": thin parts lift where they are; or a JSON file that
    lists them, docs/wings.md
strict : raise ValueError where the mesh is open, crosses itself or is otherwise no body; default: wrap it
    into a closed surface, with a warning that has volume and area before and after
cache : folder in which results are stored and found by content

Raises ValueError in one line for a sheet without `sheet`, and for what cannot be wrapped either.
Cost: a second or two for a thousand faces.)")
      .def_static(
          "from_shape", &fromShape, py::arg("shape"), py::kw_only(), py::arg("name") = "shape",
          py::arg("folder") = ".",
          R"(Builds the fluid body of a shape described as in scenes: {"type": "box", "size": [1, 2, 3]}.

`folder` is the folder of relative file names. from_mesh() describes origin, panels, threads, waterline_table, holds, up, tanks, openings, wings, strict and cache.)")
      .def_static("read", &read, py::arg("path"), "Reads an .ambient file.")
      .def("write", &write, py::arg("path"),
           "Writes an .ambient file completely, or leaves the old one.")
      .def(
          "scaled",
          [](const FluidBody& body, double factor) {
            return std::make_shared<FluidBody>(scaled(body, factor));
          },
          py::arg("factor"), "Returns the shape scaled by `factor` about F's origin.");
}

}  // namespace ambient
