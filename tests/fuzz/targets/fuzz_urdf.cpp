#include "preprocess/robot/robot_model.h"
#include "tests/fuzz/targets/fuzz_file.h"

namespace ambient::test {
namespace {

// Merges fixed joints; a valid robot must stay valid.
void readAndMerge(std::string_view text) {
  mayRefuse([&] {
    const RobotModel model = parseUrdf(std::string(text), "fuzz.urdf");
    checkRobot(model, false);
    const RobotModel merged = withoutFixedJoints(model);
    if (merged.links.empty() || merged.links.size() > model.links.size())
      throw std::logic_error("merging links has made more of them, or left none");
    checkRobot(merged, false);
  });
}

}  // namespace
}  // namespace ambient::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ambient::test::readAndMerge(ambient::test::textOf(data, size));
  return 0;
}
