#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "bullet_ambient/base/fnv1a.h"
#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/scene/scene_reader.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

namespace py = pybind11;

/// Makes a scene from a dict, a path or the name of a scene.
Scene makeScene(const py::object& source, const py::object& overrides, const py::object& folder) {
  std::vector<SceneOverride> changes;
  if (!overrides.is_none()) changes = overridesFrom(overrides);
  if (py::isinstance<py::dict>(source)) {
    const std::filesystem::path file = pathFrom(folder) / "scene.json";
    return parseScene(jsonFrom(source, file.string() + ": "), file, changes);
  }
  const std::filesystem::path file = findScene(pathFrom(source).string(), sceneFolders());
  requireReadable(file);
  return readScene(file, changes);
}

std::vector<std::string> bodyNames(const Scene& scene) {
  std::vector<std::string> names;
  for (const BodyDef& body : scene.bodies) names.push_back(body.name);
  return names;
}

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const auto& file : listScenes(sceneFolders())) names.push_back(file.stem().string());
  return names;
}

/// Converts integers to floating point: 8 and 8.0 get the same key.
void unifyNumbers(nlohmann::json& value) {
  if (value.is_number_integer()) value = value.get<double>();
  if (value.is_structured())
    for (nlohmann::json& part : value) unifyNumbers(part);
}

/// Key of a run's result, 16 hexadecimal digits: hash of the scene without description, schema and
/// threads, of the files that its shapes name, and of version and solver of this library.
/// @throws std::runtime_error if one of these files cannot be read.
std::string keyOf(const Scene& scene) {
  auto document = nlohmann::json::parse(scene.text);
  for (const char* key : {"$schema", "description", "threads"}) document.erase(key);
  unifyNumbers(document);
  std::string content = libraryVersion() + "\n" + document.dump();
  for (const BodyDef& body : scene.bodies) {
    const std::filesystem::path file = fileOf(body.shape);
    if (!file.empty()) content += "\n" + std::to_string(fnv1a64(readBytes(file)));
  }
  return hashText(fnv1a64(content));
}

// Comparison, hash, print and pickle: scenes of one text and file are equal.
void bindIdentity(py::class_<Scene>& type) {
  type.def(
          "__eq__",
          [](const Scene& a, const Scene& b) { return a.text == b.text && a.file == b.file; },
          py::is_operator())
      .def("__hash__", [](const Scene& scene) { return py::hash(py::str(scene.text)); })
      .def("__repr__",
           [](const Scene& scene) {
             return "<Scene \"" + scene.name + "\": " + std::to_string(scene.bodies.size()) +
                    " bodies>";
           })
      .def(py::pickle(
          [](const Scene& scene) { return py::make_tuple(scene.text, scene.file.string()); },
          [](const py::tuple& state) {
            return parseScene(state[0].cast<std::string>(), state[1].cast<std::string>());
          }));
}

}  // namespace

std::vector<SceneOverride> overridesFrom(const py::dict& changes) {
  std::vector<SceneOverride> overrides;
  for (const auto& [path, value] : changes)
    overrides.push_back(
        {path.cast<std::string>(),
         jsonFrom(py::reinterpret_borrow<py::object>(value), path.cast<std::string>())});
  return overrides;
}

void bindScene(py::module_& module) {
  py::class_<Scene> type(
      module, "Scene",
      R"(Bodies, joints and a fluid, checked against the schema of scenes. Immutable.

Parameters
----------
source : the path of a JSON file, the name of one of scene_names(), or a dict of the same content
overrides : {"bodies.0.mass": 0.1, ...}
folder : folder of relative file names in a dict; default: the current folder

>>> Scene("sphere_fall", {"duration": 1}).duration
1.0
>>> Scene("sphere_fall", {"duration": -1})
Traceback (most recent call last):
    ...
ValueError: ...sphere_fall.json: duration is -1; must be > 0
)");
  bindIdentity(type);
  type.def(py::init(&makeScene), py::arg("source"), py::arg("overrides") = py::none(),
           py::kw_only(), py::arg("folder") = ".")
      .def(
          "replace",
          [](const Scene& scene, const py::dict& changes) {
            return parseScene(scene.text, scene.file, overridesFrom(changes));
          },
          py::arg("overrides"), "Returns the scene with overrides.")
      .def_property_readonly(
          "document",
          [](const Scene& scene) -> py::dict {
            return py::module_::import("json").attr("loads")(scene.text);
          },
          "Content of the scene as a dict, with overrides.")
      .def_readonly("name", &Scene::name, "Name of the file without extension.")
      .def_property_readonly(
          "file", [](const Scene& scene) { return scene.file.string(); },
          "Path of the file; names in it are relative to its folder.")
      .def_readonly("description", &Scene::description, "Description in one sentence.")
      .def_readonly("duration", &Scene::duration, "Duration of a run [s].")
      .def_readonly("time_step", &Scene::time_step, "Fixed time step of the world [s].")
      .def_readonly("output_step", &Scene::output_step,
                    "Time between two samples of the output [s].")
      .def_property_readonly(
          "medium", [](const Scene& scene) { return toPython(scene.medium); },
          "Medium of all bodies without a density of their own.")
      .def_property_readonly("bodies", &bodyNames, "Names of the bodies.")
      .def_property_readonly(
          "key", &keyOf, "Hash (16 digits) of everything that a run depends on, see run_cases().");
  module.def(
      "_parse_scene",
      [](const py::dict& document, const py::object& file, const py::dict& changes) {
        return parseScene(jsonFrom(document), pathFrom(file), overridesFrom(changes));
      },
      py::arg("document"), py::arg("file"), py::arg("overrides"));
  module.def("_json_text", &jsonFrom, py::arg("value"), py::arg("place"));
  module.def("scene_names", &sceneNames,
             "Returns the names of the scenes that come with the library.");
}

}  // namespace ambient
