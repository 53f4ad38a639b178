#pragma once

#include <random>
#include <vector>

#include "tests/study/stability/atlas_run.h"

namespace ambient {

/// A part of the stability atlas: values that its cases are drawn from.
struct AtlasRow {
  const char* name = "";
  const char* what = "";  ///< one line for the table
  PressureLaw law = PressureLaw::kForm;
  std::vector<double> hertz, density_ratios, speeds, spins;
  bool is_needle = false;                   ///< true: the needle alone; false: the other shapes
  std::vector<double> load_ratios = {0};    ///< AtlasCase::load_ratio
  std::vector<AtlasSetting> settings = {};  ///< empty: all
};

/// All rows.
const std::vector<AtlasRow>& atlasRows();

/// Draws the cases of a row at random. Each value of a quantity occurs as often as any other;
/// combinations are random.
class AtlasCaseGenerator {
 public:
  /// @pre row and the shapes of makeAtlasShapes() outlive the generator
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
