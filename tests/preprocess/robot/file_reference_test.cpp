#include "preprocess/robot/file_reference.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

TEST(FileReference, PathsAreBesideTheFile) {
  EXPECT_EQ(resolveReference("m/a.obj", "robots/r.urdf", {}, "r"), "robots/m/a.obj");
  EXPECT_EQ(resolveReference("/m/a.obj", "robots/r.urdf", {}, "r"), "/m/a.obj");
  EXPECT_EQ(resolveReference("file:///m/a.obj", "robots/r.urdf", {}, "r"), "/m/a.obj");
}

TEST(FileReference, PackagesAreFoundAboveTheFile) {
  const TemporaryFolder folder;
  const fs::path root = fs::path(folder / "");
  fs::create_directories(root / "rover/urdf");
  fs::create_directories(root / "arm");
  const fs::path file = root / "rover/urdf/r.urdf";
  const auto find = [&](const std::string& reference, const PackageFolders& packages = {}) {
    return fs::weakly_canonical(resolveReference(reference, file, packages, "r"));
  };
  const fs::path real = fs::canonical(root);
  EXPECT_EQ(find("package://rover/a.obj"), real / "rover/a.obj");
  EXPECT_EQ(find("model://arm/a.obj"), real / "arm/a.obj");
  EXPECT_EQ(find("package://arm/a.obj", {{"arm", "/given"}}), "/given/a.obj");
}

TEST(FileReference, RefusesWhatItCannotFind) {
  for (const char* bad :
       {"", "http://a/b", "package://no_such_package/a", "package://", "package://usr"})
    EXPECT_THROW(resolveReference(bad, "/usr/r.urdf", {}, "r"), std::runtime_error) << bad;
}

}  // namespace
}  // namespace ambient
