#include "tests/golden/golden_world.h"

namespace ambient::test {

std::vector<GoldenRun> goldenRuns() {
  std::vector<GoldenRun> all;
  for (const auto& runs : {goldenFlights(), goldenContacts(), goldenJoints()})
    all.insert(all.end(), runs.begin(), runs.end());
  return all;
}

}  // namespace ambient::test
