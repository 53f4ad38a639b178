#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/builder/parse_exit.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/option_values.h"

namespace ambient {
namespace {

/// Edit distance with swaps of neighbours (optimal string alignment).
std::size_t distanceBetween(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t replace = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + replace});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

/// Finds the word with the fewest insertions, deletions, replacements and swaps of neighbours to
/// become `word`; empty if that number exceeds a third of the letters of `word`, at least two.
std::string closestWord(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t kLeast = 2;
  std::string closest;
  std::size_t smallest = std::max(kLeast, word.size() / 3) + 1;
  for (const std::string& candidate : words) {
    const std::size_t distance = distanceBetween(word, candidate);
    if (distance >= smallest) continue;
    smallest = distance;
    closest = candidate;
  }
  return closest;
}

/// A sentence about a first word that is no command, if there is one.
std::string unknownCommand(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string word = argv[1];
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return {};
  const std::string closest = closestWord(word, names);
  return "unknown command '" + word + "'" +
         (closest.empty() ? "; --help lists them" : "; did you mean '" + closest + "'?");
}

/// The arguments, last one first as CLI11 wants them; --wrap takes a number that follows, and
/// nothing else.
std::vector<std::string> argumentsOf(int argc, char** argv) {
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    arguments.emplace_back(argv[i]);
    if (arguments.back() != "--wrap") continue;
    char* end = nullptr;
    const bool has_size = i + 1 < argc && (std::strtod(argv[i + 1], &end), *end == '\0');
    arguments.back() += std::string("=") + (has_size ? argv[++i] : kDefaultWrap);
  }
  std::reverse(arguments.begin(), arguments.end());
  return arguments;
}

int run(int argc, char** argv) {
  CLI::App app("Makes, shows and evaluates .ambient files: what a fluid needs to know of a shape.",
               "ambient_preprocess");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("ambient_preprocess ") + AMBIENT_VERSION);
  for (const auto add : {addBuild, addCheck, addInspect, addLoads, addPolar, addExport, addUpgrade})
    add(app);
  for (const std::string& message : {emptyArgument(argc, argv), unknownCommand(app, argc, argv)}) {
    if (message.empty()) continue;
    std::cerr << "ambient_preprocess: " << plainLine(message) << "\n";
    return kBadUsage;
  }
  try {
    app.parse(argumentsOf(argc, argv));
  } catch (const CLI::RuntimeError& failed) {
    return failed.get_exit_code();
  } catch (const CLI::ParseError& error) {
    return exitAt(app, error);
  } catch (const UsageError& error) {
    std::cerr << "ambient_preprocess: " << plainLine(error.what()) << "\n";
    return kBadUsage;
  }
  return 0;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  return ambient::runProgram("ambient_preprocess", [&] { return ambient::run(argc, argv); });
}
