#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/benchmark/rivals/engine.h"

namespace ambient::rivals {

/// What a fluid costs: steps of a scene with it and without.
struct CostCase {
  std::string name;
  Scene scene;
  int settling = 30;  ///< steps before the first that is timed
};

/// One number that has a closed form or was measured.
struct AccuracyCase {
  std::string name, unit;
  std::string source;    ///< of the reference
  double reference = 0;  ///< 0: what is computed is itself an error
  Scene scene;           ///< one body
  /// Steps the world and returns the number; not finite: none was seen.
  std::function<double(World&, const Scene&)> measure;
};

/// Crowds of `count` bodies; a pile of edge^3 boxes.
std::vector<CostCase> costCases(int count, int edge);
std::vector<AccuracyCase> accuracyCases();

/// `count` copies of the body of a scene, apart from each other.
Scene crowdOf(const Scene& scene, int count);

/// Kinetic energy of an ellipsoid and of the ideal flow around it, by Lamb's added mass [J].
double energyInIdealFlow(const Solid& ellipsoid, const Motion& motion);

}  // namespace ambient::rivals
