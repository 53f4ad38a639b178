#include "demos/worlds/batch_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/plain_text.h"
#include "demos/simulation/body_preparation.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

template <class Names>
std::string wordsOf(const Names& names) {
  std::string words;
  for (const auto& name : names) words += (words.empty() ? "" : ", ") + std::string(name.second);
  return words;
}

template <class Names>
auto kindOf(const std::string& key, const Names& names, const std::string& word) {
  const auto kind = valueOf(names, word);
  if (!kind) raiseInputError(key, "is \"", word, "\"; must be one of ", wordsOf(names));
  return *kind;
}

BatchField fieldOf(const std::string& kind, const std::string& body, int& end, int size) {
  const BatchField field{body.empty() ? kind : kind + ":" + body, end, size};
  end += size;
  return field;
}

void requireFinite(const std::string& key, double value, bool is_fine, const char* limit) {
  if (!std::isfinite(value) || !is_fine) raiseInputError(key, "is ", value, "; must be ", limit);
}

/// Refuses what has a number for each thruster, foil or joint of a scene without any.
void requireNumbers(const std::string& key, const std::string& kind, int size) {
  if (size > 0) return;
  const bool is_of_thrusters = kind.rfind("thrust", 0) == 0 || kind == "turns";
  const char* things = is_of_thrusters              ? "thrusters"
                       : kind.rfind("foil", 0) == 0 ? "foils"
                                                    : "joints";
  raiseInputError(key, "is \"", kind, "\", and the scene has no ", things);
}

/// Whether it varies one body; else all of the world.
bool isOfBody(VariationKind kind) {
  return kind <= VariationKind::kCentreOfMass ||
         (kind >= VariationKind::kPosition && kind <= VariationKind::kTwist);
}

bool isFactorFromZero(VariationKind kind) {
  return kind == VariationKind::kLag || kind == VariationKind::kFriction;
}

/// Repeats a single number for all of a field.
std::vector<double> boundsOf(const std::string& key, std::vector<double> bounds, int size) {
  if (bounds.size() == 1) bounds.resize(static_cast<std::size_t>(size), bounds[0]);
  if (bounds.size() != static_cast<std::size_t>(size))
    raiseInputError(key, "has bounds of ", bounds.size(), " numbers; must be 1 or ", size);
  for (const double bound : bounds) requireFinite(key, bound, true, "finite");
  return bounds;
}

}  // namespace

BatchPlan::BatchPlan(const Scene& from, const BatchSettings& with) : scene(from), settings(with) {
  requireFinite("worlds", settings.worlds, settings.worlds >= 1, ">= 1");
  requireFinite("substeps", settings.substeps, settings.substeps >= 1, ">= 1");
  requireFinite("threads", settings.threads, settings.threads >= 0, ">= 0");
  requireFinite("together", settings.together, settings.together >= 1, ">= 1");
  requireFinite("most_steps", static_cast<double>(settings.most_steps), settings.most_steps >= 0,
                ">= 0");
  if (settings.gust) gaussMarkovGusts(*settings.gust);  // checks it
  SceneBodyCache cache(settings.fluid_bodies, scene.threads);
  bodies = prepareBodies(scene, cache);
  cache.save();
  for (std::size_t i = 0; i < scene.robots.size(); ++i)
    for (const LinkModel& link : scene.robots[i].model->links)
      if (link.parent >= 0 && link.joint.isAxial()) joints.push_back({i, link.joint.name});
  for (const ActionDef& def : settings.actions) addAction(def);
  for (const VariationDef& def : settings.variations) addVariation(def);
  for (const ObservationDef& def : settings.observations) addObservation(def);
}

bool BatchPlan::hasFlow() const {
  const auto flows = [](const VariationField& v) {
    return v.kind == VariationKind::kCurrent || v.kind == VariationKind::kGust;
  };
  return settings.gust || std::any_of(variations.begin(), variations.end(), flows);
}

std::size_t BatchPlan::bodyOf(const std::string& key, const std::string& name) const {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (name.empty() ? scene.bodies[i].mass > 0 : scene.bodies[i].name == name) return i;
  raiseInputError(key, "names the body \"", name, "\", which the scene does not have");
}

int BatchPlan::sizeOf(int size) const {
  if (size == kPerThruster) return static_cast<int>(scene.thrusters.size());
  if (size == kPerJoint) return static_cast<int>(joints.size());
  if (size == kPerFoil) return static_cast<int>(scene.foils.size());
  return size == kPerParameter ? parameter_size : size;
}

int BatchPlan::sizeOf(ActionKind kind) const {
  if (kind == ActionKind::kThrusters) return sizeOf(kPerThruster);
  if (kind == ActionKind::kFoils) return sizeOf(kPerFoil);
  return kind == ActionKind::kWrench || kind == ActionKind::kWrenchWorld ? 6 : sizeOf(kPerJoint);
}

int BatchPlan::sizeOf(VariationKind kind) const {
  switch (kind) {
    case VariationKind::kThrust:
      return sizeOf(kPerThruster);
    case VariationKind::kJointPosition:
      return sizeOf(kPerJoint);
    case VariationKind::kTwist:
      return 6;
    case VariationKind::kCurrent:
    case VariationKind::kCentreOfMass:
    case VariationKind::kPosition:
    case VariationKind::kAttitude:
    case VariationKind::kTarget:
      return 3;
    default:
      return 1;
  }
}

std::vector<int> BatchPlan::rowsOf(const std::string& key, std::vector<int> rows, int size) {
  most_numbers = std::max(most_numbers, size);
  if (rows.empty()) {
    rows.resize(static_cast<std::size_t>(size));
    std::iota(rows.begin(), rows.end(), 0);
  }
  for (const int row : rows)
    if (row < 0 || row >= size)
      raiseInputError(key, "has the row ", row, "; must be from 0 to ", size - 1);
  return rows;
}

void BatchPlan::requireMotors(const std::string& key, const std::vector<int>& rows) const {
  for (const int row : rows) {
    const BatchJoint& joint = joints[static_cast<std::size_t>(row)];
    if (scene.robots[joint.robot].motors.count(joint.name) == 0)
      raiseInputError(key, "drives the joint \"", joint.name,
                      "\", which has no motor in the scene");
  }
}

void BatchPlan::requireMoving(const std::string& key, std::size_t body) const {
  if (!(scene.bodies[body].mass > 0))
    raiseInputError(key, "names the body \"", scene.bodies[body].name, "\", which is static");
}

void BatchPlan::requireMovableCentre(const std::string& key, std::size_t body) const {
  requireMoving(key, body);
  const std::string& name = scene.bodies[body].name;
  if (scene.bodies[body].link)
    raiseInputError(key, "names \"", name, "\", a link of a robot; must be a rigid body");
  for (const JointDef& joint : scene.joints)
    if (std::count(joint.bodies.begin(), joint.bodies.end(), name) > 0)
      raiseInputError(key, "names the body \"", name, "\"; must have no joints");
}

void BatchPlan::addAction(const ActionDef& def) {
  const std::string key = "actions[" + std::to_string(actions.size()) + "]";
  const ActionKind kind = kindOf(key, kActionNames, def.kind);
  requireFinite(key + ".scale", def.scale, true, "finite");
  requireNumbers(key, def.kind, sizeOf(kind));
  std::vector<int> rows = rowsOf(key, def.rows, sizeOf(kind));
  const int size = static_cast<int>(rows.size());
  const std::size_t body = bodyOf(key, def.body);
  if (kind == ActionKind::kMotorPosition || kind == ActionKind::kMotorVelocity)
    requireMotors(key, rows);
  if (kind == ActionKind::kWrench || kind == ActionKind::kWrenchWorld) requireMoving(key, body);
  actions.push_back(
      {kind, body, std::move(rows), def.scale, fieldOf(def.kind, def.body, action_size, size)});
}

void BatchPlan::addVariation(const VariationDef& def) {
  const std::string key = "variation \"" + def.kind + "\"";
  const VariationKind kind = kindOf(key, kVariationNames, def.kind);
  const int size = sizeOf(kind);
  requireNumbers(key, def.kind, size);
  if (kind == VariationKind::kGust && !settings.gust)
    raiseInputError(key, "is a factor on gusts, and there are none");
  const std::size_t body = bodyOf(key, def.body);
  if (kind <= VariationKind::kInertia) requireMoving(key, body);
  if (kind == VariationKind::kCentreOfMass) requireMovableCentre(key, body);
  for (const VariationField& other : variations)
    if (other.kind == kind && (other.body == body || !isOfBody(kind)))
      raiseInputError(key, "is given twice");
  VariationField v{kind,
                   body,
                   boundsOf(key, def.lowest, size),
                   boundsOf(key, def.highest, size),
                   def.is_logarithmic,
                   fieldOf(def.kind, def.body, parameter_size, size)};
  const bool is_factor = kind <= VariationKind::kLoads;
  for (std::size_t i = 0; i < v.lowest.size(); ++i) {
    if (!(v.lowest[i] <= v.highest[i]))
      raiseInputError(key, "is from ", v.lowest[i], " to ", v.highest[i], "; must not fall");
    requireFinite(key, v.lowest[i], v.lowest[i] > 0 || !(is_factor || v.is_logarithmic), "> 0");
    requireFinite(key, v.lowest[i], v.lowest[i] >= 0 || !isFactorFromZero(kind), ">= 0");
    if (!v.is_logarithmic) continue;
    v.lowest[i] = portable::log(v.lowest[i]);
    v.highest[i] = portable::log(v.highest[i]);
  }
  variations.push_back(std::move(v));
}

void BatchPlan::addObservation(const ObservationDef& def) {
  const std::string key = "observations[" + std::to_string(observations.size()) + "]";
  const ObservationKind* kind = findObservation(def.kind);
  if (!kind) raiseInputError(key, "is \"", def.kind, "\"; must be one of ", observationNames());
  requireFinite(key + ".noise", def.noise, def.noise >= 0, ">= 0");
  requireFinite(key + ".bias", def.bias, def.bias >= 0, ">= 0");
  requireFinite(key + ".place", def.place.norm(), true, "finite");
  if (kind->size == kPerParameter && parameter_size == 0)
    raiseInputError(key, "has no numbers: nothing varies");
  requireNumbers(key, def.kind, sizeOf(kind->size));
  std::vector<int> rows = rowsOf(key, def.rows, sizeOf(kind->size));
  const int size = static_cast<int>(rows.size());
  const std::size_t body = bodyOf(key, def.body);
  int place_in_accelerated = -1;
  if (def.kind == "imu") {
    const auto found = std::find(accelerated.begin(), accelerated.end(), body);
    place_in_accelerated = static_cast<int>(found - accelerated.begin());
    if (found == accelerated.end()) accelerated.push_back(body);
  }
  observations.push_back({kind->read, body, std::move(rows), def.place, def.noise, def.bias,
                          fieldOf(def.kind, def.body, observation_size, size),
                          place_in_accelerated});
}

}  // namespace ambient
