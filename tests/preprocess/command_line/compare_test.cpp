#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using nlohmann::json;

class Compare : public ::testing::Test {
 protected:
  Compare() {
    BuildSettings settings;
    settings.flow.max_panels = 0;
    body_ = makeFluidBody(makeBoxMesh({1, 2, 3}, 200), settings);
  }

  std::string write(const FluidBody& body, const char* name) const {
    const std::string file = (folder_ / name).string();
    writeFluidBody(body, file);
    return file;
  }

  ProgramResult compare(const FluidBody& other, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"compare", write(body_, "a.ambient"),
                                       write(other, "b.ambient"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(AMBIENT_PREPROCESS, arguments);
  }

  FluidBody body_;
  TemporaryFolder folder_;
};

TEST_F(Compare, SameFilesDoNotDiffer) {
  FluidBody renamed = body_;
  renamed.name = "another name";
  const ProgramResult result = compare(renamed, {"--tolerance", "0"});
  EXPECT_EQ(result.exit_code, 0);
  const json report = json::parse(result.output);
  EXPECT_EQ(report["same"], true);
  for (const auto& entry : report.items()) {
    if (entry.key() != "same") {
      EXPECT_EQ(entry.value().get<double>(), 0) << entry.key();
    }
  }
}

TEST_F(Compare, EveryBlockIsSeenByItself) {
  const auto differenceIn = [&](const FluidBody& other) {
    const ProgramResult result = compare(other);
    EXPECT_EQ(result.exit_code, 1);
    return json::parse(result.output);
  };
  FluidBody other = body_;
  other.added_mass(5, 5) += 1e-3 * other.added_mass.diagonal().tail<3>().maxCoeff();
  json report = differenceIn(other);
  EXPECT_NEAR(report["added_mass_translation"].get<double>(), 1e-3, 1e-5);
  EXPECT_EQ(report["added_mass_rotation"].get<double>(), 0);
  other = body_;
  other.added_mass(0, 0) *= 1.5;
  report = differenceIn(other);
  EXPECT_GT(report["added_mass_rotation"].get<double>(), 0.01);
  EXPECT_EQ(report["added_mass_translation"].get<double>(), 0);
  other = body_;
  other.volume *= 1.001;
  EXPECT_NEAR(differenceIn(other)["volume"].get<double>(), 1e-3, 1e-5);
  other = body_;
  other.uniform_mass.centre.x() += 0.01;
  EXPECT_GT(differenceIn(other)["uniform_mass"].get<double>(), 1e-3);
  other = body_;
  other.sphere_radius = std::cbrt(body_.volume / 4);
  EXPECT_GT(differenceIn(other)["pressure"].get<double>(), 1e-2) << "loaded as a sphere";
  other = body_;
  other.faces.area[3] *= 8;
  EXPECT_GT(differenceIn(other)["pressure"].get<double>(), 1e-3);
}

TEST_F(Compare, ToleranceDecides) {
  FluidBody other = body_;
  other.volume *= 1.001;
  EXPECT_EQ(compare(other, {"--tolerance", "0.01"}).exit_code, 0);
  EXPECT_EQ(compare(other, {"--tolerance", "1e-4"}).exit_code, 1);
  const ProgramResult bad = compare(other, {"--tolerance", "-1"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(bad.errors, "ambient_preprocess: --tolerance: -1 must be finite and not negative\n");
}

TEST_F(Compare, MeshesOfOneBodyDifferByTheirFacets) {
  BuildSettings settings;
  settings.flow.max_panels = 0;
  const json report =
      json::parse(compare(makeFluidBody(makeBoxMesh({1, 2, 3}, 800), settings)).output);
  EXPECT_LT(report["volume"].get<double>(), 1e-12);
  EXPECT_GT(report["added_mass_translation"].get<double>(), 1e-3);
  EXPECT_LT(report["added_mass_translation"].get<double>(), 0.1);
  EXPECT_LT(report["pressure"].get<double>(), 0.05);
}

}  // namespace
}  // namespace ambient
