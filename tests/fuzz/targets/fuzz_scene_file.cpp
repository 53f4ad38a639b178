#include "demos/scene/scene_reader.h"
#include "tests/fuzz/targets/fuzz_file.h"

namespace ambient::test {
namespace {

// Reads a scene; a first line "PATH=VALUE" becomes an argument of --set.
void readWithOverride(std::string_view bytes) {
  static FuzzFile file(".json");
  const std::string_view line = bytes.substr(0, bytes.find('\n'));
  const bool is_override = line.find('=') != std::string_view::npos && line.front() != '{';
  mayRefuse([&] {
    std::vector<SceneOverride> overrides;
    if (is_override) {
      try {
        overrides.push_back(parseOverride(std::string(line)));
      } catch (const std::invalid_argument&) {  // bad usage
        return;
      }
    }
    readScene(file.write(is_override ? bytes.substr(line.size()) : bytes), overrides);
  });
}

}  // namespace
}  // namespace ambient::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ambient::test::readWithOverride(ambient::test::textOf(data, size));
  return 0;
}
