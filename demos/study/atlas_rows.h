#pragma once

#include <random>
#include <vector>

#include "demos/study/atlas_run.h"

namespace ambient {

/// A part of the stability atlas: what its cases are drawn from.
struct AtlasRow {
  const char* name = "";
  const char* what = "";  ///< in one line
  PressureLaw law = PressureLaw::kPublished;
  std::vector<double> hertz, density_ratios, speeds, spins;
  bool is_needle = false;                   ///< in place of the other shapes
  std::vector<double> load_ratios = {0};    ///< AtlasCase::load_ratio
  std::vector<AtlasSetting> settings = {};  ///< empty: all
};

/// All rows.
const std::vector<AtlasRow>& atlasRows();

/// Draws the cases of a row: each value of each quantity as often as any other, in all combinations
/// by chance.
class AtlasCaseGenerator {
 public:
  /// @pre row and shapes, those of makeAtlasShapes(), outlive it
  AtlasCaseGenerator(const AtlasRow& row, const std::vector<AtlasShape>& shapes, unsigned seed)
      : row_(row), shapes_(shapes), engine_(seed) {}

  AtlasCase next();

 private:
  template <class Value>
  const Value& any(const std::vector<Value>& values) {
    return values[engine_() % values.size()];
  }

  const AtlasRow& row_;
  const std::vector<AtlasShape>& shapes_;
  std::mt19937 engine_;
};

}  // namespace ambient
