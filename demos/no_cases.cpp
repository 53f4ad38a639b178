#include <stdexcept>

#include "demos/cases_command.h"
#include "demos/scene/scene_robots.h"

namespace ambient {
namespace {

[[noreturn]] void refuse() {
  throw std::invalid_argument(std::string("--cases ") + kNeedsWholeDemo);
}

}  // namespace

void checkCases(const CasesArguments&) { refuse(); }

bool runCasesCommand(const CasesArguments&) { refuse(); }

}  // namespace ambient
