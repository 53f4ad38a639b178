#include <array>
#include <memory>

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "tests/fuzz/targets/fuzz_file.h"

namespace ambient::test {
namespace {

constexpr std::array<const char*, 6> kExtensions{".obj", ".stl", ".ply", ".gltf", ".glb", ".off"};

// The first byte chooses the format and whether the surface is a sheet.
void importAndCheck(std::uint8_t choice, std::string_view bytes) {
  static std::array<std::unique_ptr<FuzzFile>, kExtensions.size()> files;
  std::unique_ptr<FuzzFile>& file = files[choice % kExtensions.size()];
  if (!file) file = std::make_unique<FuzzFile>(kExtensions[choice % kExtensions.size()]);
  const std::filesystem::path& path = file->write(bytes);
  mayRefuse([&] { checkMesh(importMesh(path).mesh, "fuzz", choice >= 128); });
}

}  // namespace
}  // namespace ambient::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) ambient::test::importAndCheck(data[0], ambient::test::textOf(data + 1, size - 1));
  return 0;
}
