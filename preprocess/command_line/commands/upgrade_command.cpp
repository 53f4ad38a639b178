#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/blocked_signals.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {
namespace {

void upgrade(const std::string& file) {
  const bool is_new = isComplete(readFluidBody(file));
  if (!is_new) {
    const FluidBody body = readPrepared(file);
    const BlockedSignals until_renamed;
    writeFluidBody(body, file);
  }
  std::cout << plainLine(file) << (is_new ? ": is up to date\n" : ": upgraded\n");
}

}  // namespace

void addUpgrade(CLI::App& app) {
  const auto files = std::make_shared<std::vector<std::string>>();
  CLI::App& command = *app.add_subcommand(
      "upgrade", "Completes .ambient files of earlier versions, which the runtime refuses");
  command.add_option("FILE.ambient", *files, "The files, which are written anew in place")
      ->required();
  command.callback([files] {
    for (const std::string& file : *files) upgrade(file);
  });
}

}  // namespace ambient
