// The bits of the scenes of data/scenes do not hang on the processor's variants of the C library's
// sine and cosine. `processor_test --run FOLDER` prints a hash for each body of each scene, run to
// its end; FOLDER keeps the fluid bodies. The C library chooses its variants when a program starts.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "bullet_ambient/base/fnv1a.h"
#include "demos/scene/scene_reader.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/bits_of.h"
#include "tests/support/run_program.h"

namespace ambient::test {
namespace {

std::string bytesOf(const MotionSample& sample) {
  std::string bytes = bitsOf(sample.time);
  for (int i = 0; i < 3; ++i) bytes += bitsOf(sample.position[i]);
  for (int i = 0; i < 4; ++i) bytes += bitsOf(sample.orientation.coeffs()[i]);
  for (int i = 0; i < 6; ++i) bytes += bitsOf(sample.twist.vector()[i]);
  return bytes;
}

void printHashes(const std::filesystem::path& file, SceneBodyCache& cache) {
  const Scene scene = readScene(file);
  const RunRecord run = runPrepared(scene, prepareBodies(scene, cache));
  for (std::size_t i = 0; i < run.motion.size(); ++i) {
    std::string bytes;
    for (const MotionSample& sample : run.motion[i]) bytes += bytesOf(sample);
    std::printf("%s %s %s\n", file.stem().string().c_str(), scene.bodies[i].name.c_str(),
                hashText(fnv1a64(bytes)).c_str());
  }
}

void printAll(const std::filesystem::path& folder) {
  SceneBodyCache cache(folder);
  for (const auto& file : listScenes({std::filesystem::path(AMBIENT_DATA) / "scenes"}))
    printHashes(file, cache);
  cache.save();
}

std::string runAll(const TemporaryFolder& folder, const char* tunables) {
  setenv("GLIBC_TUNABLES", tunables, 1);
  const ProgramResult result = runProgram("/proc/self/exe", {"--run", folder.path().string()});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return result.output;
}

TEST(Processors, GiveTheSameBitsToAllScenes) {
  const TemporaryFolder folder;
  std::istringstream native(runAll(folder, ""));
  std::istringstream plain(runAll(folder, "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"));
  std::string a, b;
  int lines = 0;
  for (; std::getline(native, a) && std::getline(plain, b); ++lines) EXPECT_EQ(a, b);
  EXPECT_GT(lines, 200);
  EXPECT_FALSE(std::getline(plain, b)) << b;
}

}  // namespace
}  // namespace ambient::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc < 3) return RUN_ALL_TESTS();
  using namespace ambient::test;
  printAll(argv[2]);
  return 0;
}
