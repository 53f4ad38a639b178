#pragma once

#include <gtest/gtest.h>

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/mass_properties.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/support/temporary_folder.h"

namespace ambient {

/// Writes small mesh files and reads them.
class MeshImport : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = folder_ / name;
    writeText(file, text);
    return file;
  }

  std::string refusal(const std::filesystem::path& file, double scale = 1) const {
    std::string message = messageOf([&] { importMesh(file, scale); });
    const std::string path = file.string();
    EXPECT_EQ(message.substr(0, path.size() + 2), path + ": ") << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message.substr(std::min(message.size(), path.size() + 2));
  }

  TemporaryFolder folder_;
};

inline MeshProperties propertiesOf(const std::filesystem::path& file, double scale = 1) {
  const std::string name = file.string();
  return computeMassProperties(
      requireSound(checkMesh(importMesh(file, scale).mesh, name), name).mesh);
}

}  // namespace ambient
