#include <iostream>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/fluid_body_report.h"

namespace ambient {

void runInspect(const InspectArguments& arguments) {
  const FluidBody body = readFluidBody(arguments.file);
  std::cout << (arguments.json ? reportJson(body, std::nullopt)
                               : reportTable(body, arguments.file));
}

}  // namespace ambient
