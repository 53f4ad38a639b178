#include <stdexcept>

#include "demos/cases_command.h"
#include "demos/gltf/gltf_text.h"
#include "demos/scene/scene_robots.h"

namespace ambient {
namespace {

[[noreturn]] void refuse(const std::string& option) {
  throw std::invalid_argument(option + " " + kNeedsWholeDemo);
}

}  // namespace

bool isGltfName(const std::filesystem::path&) { refuse("--gltf"); }

std::string makeGltf(const std::filesystem::path&, const Scene&, const std::vector<PreparedBody>&,
                     const std::vector<std::vector<MotionSample>>&) {
  refuse("--gltf");
}

void checkCases(const CasesArguments&) { refuse("--cases"); }

bool runCasesCommand(const CasesArguments&) { refuse("--cases"); }

}  // namespace ambient
