#include "demos/scene/scene_reader.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "demos/scene/scene_parts.h"
#include "demos/scene/scene_water.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {

namespace {

namespace fs = std::filesystem;

fs::path programFolder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

/// Returns the folder of the file that this code was linked into: of the module, its package.
fs::path libraryFolder() {
  static const char here = 0;
  Dl_info found;
  return dladdr(&here, &found) != 0 ? fs::path(found.dli_fname).parent_path() : fs::path();
}

bool looksLikePath(const std::string& text) {
  return text.find('/') != std::string::npos || fs::path(text).extension() == ".json";
}

}  // namespace

std::vector<fs::path> sceneFolders() {
  const fs::path program = programFolder();
  std::vector<fs::path> folders;
  for (const fs::path& folder :
       {libraryFolder() / "data/scenes", fs::path("data/scenes"), program / "../../../data/scenes",
        program / "../share/bullet_ambient/scenes", fs::path(AMBIENT_SOURCE_SCENES)}) {
    std::error_code error;
    const fs::path real = fs::canonical(folder, error);
    if (!error && fs::is_directory(real) &&
        std::find(folders.begin(), folders.end(), real) == folders.end())
      folders.push_back(real);
  }
  return folders;
}

std::vector<fs::path> listScenes(const std::vector<fs::path>& folders) {
  std::map<std::string, fs::path> by_name;
  for (const fs::path& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".json")
        by_name.emplace(entry.path().stem().string(), entry.path());
  std::vector<fs::path> files;
  for (const auto& [name, file] : by_name) files.push_back(file);
  return files;
}

fs::path findScene(const std::string& name_or_path, const std::vector<fs::path>& folders) {
  if (looksLikePath(name_or_path)) return name_or_path;
  std::string known;
  for (const fs::path& file : listScenes(folders)) {
    if (file.stem() == name_or_path) return file;
    known += (known.empty() ? "" : ", ") + file.stem().string();
  }
  throw std::runtime_error("scene \"" + name_or_path + "\" is not known; known are: " +
                           (known.empty() ? "none" : known) + "; or give the path of a .json file");
}

namespace {

using nlohmann::json;

/// Splits bodies.0.mass or bodies[0].mass into {"bodies", "0", "mass"}; keeps empty tokens.
std::vector<std::string> splitPath(const std::string& path) {
  std::vector<std::string> tokens(1);
  for (const char c : path) {
    if (c == '.' || c == '[')
      tokens.emplace_back();
    else if (c != ']')
      tokens.back() += c;
  }
  return tokens;
}

/// Returns a text as JSON. @throws std::runtime_error that begins with `whose` if it is not UTF-8
json utf8Of(const std::string& text, const std::string& source, const std::string& whose) {
  json value(text);
  try {
    static_cast<void>(value.dump());
  } catch (const json::type_error&) {
    raiseInputError(source, whose, " is not valid UTF-8");
  }
  return value;
}

/// Parses a value; a text that is not JSON becomes a string, which must be UTF-8.
json parseValue(const std::string& text, const std::string& source) {
  return json::accept(text) ? parseJson(text, source) : utf8Of(text, source, "the value");
}

/// Returns the element or member of `parent` named by `token`; creates a missing member.
json& descend(json& parent, const std::string& token, const std::string& parent_name) {
  if (parent.is_array()) {
    if (!isIndex(token) || std::stoul(token) >= parent.size())
      throw std::out_of_range(parent_name + " has " + std::to_string(parent.size()) +
                              " elements, no element " + token);
    return parent[std::stoul(token)];
  }
  if (parent.is_null()) parent = json::object();
  if (!parent.is_object() || isIndex(token))
    throw std::out_of_range(parent_name + " is " + (parent.empty() ? "not given" : parent.dump()) +
                            " and has no part " + token);
  return parent[token];
}

/// Puts the value into the scene. Creates missing objects along the path; a key that the schema
/// does not know is refused when the scene is checked.
/// @throws std::runtime_error if the scene has no such array element, or something else than an
/// object on the way; messages name `file`.
void applyOverride(json& scene, const SceneOverride& change, const std::string& file) {
  const std::vector<std::string> path = splitPath(change.path);
  const std::string option = "--set " + change.path + "=" + change.value + ": ";
  json* place = &scene;
  utf8Of(change.path, file + ": --set", "the path");
  try {
    std::vector<std::string> walked;
    for (const std::string& token : path) {
      place = &descend(*place, token, sceneSchema().placeName(walked));
      walked.push_back(token);
    }
  } catch (const std::out_of_range& error) {
    raiseInputError(file, option, error.what());
  }
  *place = parseValue(change.value, file + ": --set " + change.path);
}

/// Symmetric matrix of the array xx, yy, zz, xy, xz, yz.
Matrix3 toInertia(const json& v) {
  Matrix3 inertia;
  inertia << v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2];
  return inertia;
}

FlightSettings toFlightSettings(const json& scene) {
  FlightSettings settings;
  const auto found = scene.find("integrator");
  if (found == scene.end()) return settings;
  settings.own_flight = valueOf(kIntegratorNames, found->value("method", "leapfrog")).value();
  settings.tolerance = found->value("tolerance", settings.tolerance);
  settings.max_substeps = found->value("max_substeps", settings.max_substeps);
  return settings;
}

void readMassProperties(const json& from, BodyDef& body) {
  body.mass = from.at("mass").get<double>();
  body.mass_kind = from.value("mass_distribution", "uniform") == "surface" ? MassKind::kSurface
                                                                           : MassKind::kUniform;
  if (from.contains("inertia")) body.inertia = toInertia(from.at("inertia"));
  if (from.contains("centre_of_mass")) body.centre_of_mass = toVector(from.at("centre_of_mass"));
}

void readMotion(const json& from, BodyDef& body) {
  body.position = vectorOr(from, "position", Vector3::Zero());
  body.orientation = orientationIn(from);
  body.linear_velocity = vectorOr(from, "linear_velocity", Vector3::Zero());
  body.angular_velocity = vectorOr(from, "angular_velocity", Vector3::Zero());
}

HoldSettings toHolds(const json& from) {
  HoldSettings holds;
  holds.are_open = from.value("are_open", holds.are_open);
  holds.water = from.value("water", holds.water);
  holds.sloshing_damping = from.value("sloshing_damping", holds.sloshing_damping);
  return holds;
}

BodyDef toBody(const json& from, const Scene& scene, const std::filesystem::path& file) {
  const std::size_t index = scene.bodies.size();
  BodyDef body;
  FlowSettings& flow = body.attach.flow;
  flow.law = lawOr(from, scene.law);
  body.name = from.value("name", "body_" + std::to_string(index));
  body.shape = readShape(from.at("shape"), file.parent_path(),
                         file.string() + ": bodies[" + std::to_string(index) + "].shape");
  body.waterline_table = from.value("waterline_table", 0);
  readMassProperties(from, body);
  readMotion(from, body);
  flow.separation_angle = from.value("separation_angle", kPi / 2);
  flow.roughness = from.value("roughness", flow.roughness);
  flow.stall_lag = from.value("stall_lag", flow.stall_lag);
  flow.skin_friction = from.value("skin_friction", true);
  flow.maximum_load_error = from.value("maximum_load_error", flow.maximum_load_error);
  body.attach.medium = scene.medium;
  body.attach.medium.density = from.value("fluid_density", scene.medium.density);
  body.attach.wave_damping = from.value("wave_damping", body.attach.wave_damping);
  body.attach.added_mass_factor = from.value("added_mass_factor", body.attach.added_mass_factor);
  body.attach.load_factor = from.value("load_factor", body.attach.load_factor);
  if (from.contains("holds")) body.attach.holds = toHolds(from.at("holds"));
  body.restitution = from.value("restitution", body.restitution);
  body.friction = from.value("friction", body.friction);
  return body;
}

JointDef toJoint(const json& from) {
  JointDef joint;
  joint.bodies = from.at("bodies").get<std::vector<std::string>>();
  joint.point = toVector(from.at("point"));
  if (from.contains("axis")) joint.axis = toVector(from.at("axis"));
  return joint;
}

Scene toScene(const json& from, const std::filesystem::path& file) {
  Scene scene;
  scene.name = file.stem().string();
  scene.file = file;
  scene.text = from.dump();
  scene.description = from.value("description", "");
  scene.duration = from.at("duration").get<double>();
  scene.time_step = from.at("time_step").get<double>();
  scene.output_step = from.value("output_step", scene.time_step);
  scene.gravity = vectorOr(from, "gravity", scene.gravity);
  if (from.contains("medium")) scene.medium = toMedium(from.at("medium"), Medium{});
  if (from.contains("water")) scene.water = toWater(from.at("water"), scene.gravity);
  if (from.contains("regions"))
    for (const json& region : from.at("regions")) scene.regions.push_back(toRegion(region));
  scene.model = valueOf(kFluidModelNames, from.value("model", "ambient")).value();
  scene.linear_drag_speed = from.value("linear_drag_speed", scene.linear_drag_speed);
  scene.flight = toFlightSettings(from);
  scene.threads = from.value("threads", 0);
  scene.law = lawOr(from, scene.law);
  if (from.contains("bodies"))
    for (const json& body : from.at("bodies")) scene.bodies.push_back(toBody(body, scene, file));
  if (from.contains("robots"))
    for (const json& robot : from.at("robots")) addRobot(robot, scene);
  if (from.contains("joints"))
    for (const json& joint : from.at("joints")) scene.joints.push_back(toJoint(joint));
  if (from.contains("thrusters"))
    for (const json& thruster : from.at("thrusters"))
      scene.thrusters.push_back(toThruster(thruster, scene));
  if (from.contains("foils"))
    for (const json& foil : from.at("foils")) scene.foils.push_back(toFoil(foil, scene));
  return scene;
}

/// Normalises orientations and clamps angles, which checkScene() accepts with small tolerances.
void removeRounding(Scene& scene) {
  for (BodyDef& body : scene.bodies) {
    body.orientation.normalize();
    double& angle = body.attach.flow.separation_angle;
    if (std::abs(angle - kPi / 2) <= kAngleTolerance) angle = kPi / 2;
    angle = std::min(angle, kPi);
  }
}

}  // namespace

SceneOverride parseOverride(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw std::invalid_argument("--set " + text + ": must be PATH=VALUE");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Scene readScene(const std::filesystem::path& file, const std::vector<SceneOverride>& overrides) {
  return parseScene(readBytes(file), file, overrides);
}

Scene parseScene(const std::string& text, const std::filesystem::path& file,
                 const std::vector<SceneOverride>& overrides) {
  json document = parseJson(text, file.string());
  for (const SceneOverride& change : overrides) applyOverride(document, change, file.string());
  sceneSchema().check(document, file.string());
  Scene scene = toScene(document, file);
  checkScene(scene);
  removeRounding(scene);
  return scene;
}

}  // namespace ambient
