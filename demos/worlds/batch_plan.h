#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/simulation.h"
#include "demos/worlds/batch_settings.h"

namespace ambient {

/// One revolute or prismatic joint of a scene.
struct BatchJoint {
  std::size_t robot = 0;
  std::string name;
};

/// How many numbers a field has: a count, or that of what a scene has.
enum FieldSize : int { kPerThruster = -1, kPerJoint = -2, kPerParameter = -3, kPerFoil = -4 };

struct ObservationView;
/// Writes all numbers of an observation, without noise.
using ReadObservation = void (*)(const ObservationView& view, double* to);

struct ActionField {
  ActionKind kind;
  std::size_t body;
  std::vector<int> rows;
  double scale;
  BatchField field;
};

struct ObservationField {
  ReadObservation read;
  std::size_t body;
  std::vector<int> rows;
  Vector3 place;
  double noise, bias;
  BatchField field;
  int accelerated;  ///< of an imu: index of its body in BatchPlan::accelerated; else -1
};

struct VariationField {
  VariationKind kind;
  std::size_t body;
  std::vector<double> lowest, highest;  ///< logarithms, if it is logarithmic
  bool is_logarithmic;
  BatchField field;
};

/// Quantity that can be observed; observations.cpp has all.
struct ObservationKind {
  const char* name;
  int size;  ///< a count or a FieldSize
  ReadObservation read;
};

/// Null: there is none of this name.
const ObservationKind* findObservation(const std::string& name);
/// Names of all observations, with commas between them.
std::string observationNames();

/// Scene and settings of a batch, checked and resolved. Never changed afterwards: all threads read
/// it.
struct BatchPlan {
  /// @throws std::runtime_error or std::invalid_argument, one line that names the key, the value
  /// and the limit.
  BatchPlan(const Scene& scene, const BatchSettings& settings);

  Scene scene;
  BatchSettings settings;
  std::vector<PreparedBody> bodies;
  std::vector<BatchJoint> joints;
  std::vector<ActionField> actions;
  std::vector<VariationField> variations;
  std::vector<ObservationField> observations;
  std::vector<std::size_t> accelerated;  ///< bodies that have an imu
  int action_size = 0, parameter_size = 0, observation_size = 0;
  int most_numbers = 0;  ///< of one field before rows are taken

  double envStep() const { return settings.substeps * scene.time_step; }
  bool hasFlow() const;

 private:
  std::size_t bodyOf(const std::string& key, const std::string& name) const;
  int sizeOf(int size) const;
  int sizeOf(ActionKind kind) const;
  int sizeOf(VariationKind kind) const;
  std::vector<int> rowsOf(const std::string& key, std::vector<int> rows, int size);
  void requireMotors(const std::string& key, const std::vector<int>& rows) const;
  void requireMoving(const std::string& key, std::size_t body) const;
  void requireMovableCentre(const std::string& key, std::size_t body) const;
  void addAction(const ActionDef& def);
  void addVariation(const VariationDef& def);
  void addObservation(const ObservationDef& def);
};

}  // namespace ambient
