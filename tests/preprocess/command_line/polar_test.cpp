
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/support/refusals.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

/// Columns of one CSV row.
using Row = std::array<double, 8>;
enum Column { kAttack, kSideSlip, kLift, kDrag, kSide, kRoll, kPitch, kYaw };

class Polar : public ::testing::Test {
 protected:
  std::string write(const TriangleMesh& mesh, bool sheet = false) const {
    BuildSettings settings;
    settings.name = "body";
    settings.flow.max_panels = 0;
    settings.flow.sheet = sheet;
    const std::string file = (folder_ / "body.ambient").string();
    writeFluidBody(makeFluidBody(mesh, settings), file);
    return file;
  }

  static ProgramResult run(const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"polar", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(AMBIENT_PREPROCESS, arguments);
  }

  static std::vector<Row> polar(const std::string& file, const std::vector<std::string>& more) {
    const ProgramResult result = run(file, more);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    std::istringstream lines(result.output);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "attack,side_slip,C_L,C_D,C_Y,C_l,C_m,C_n");
    std::vector<Row> rows;
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      Row row{};
      for (double& cell : row) {
        cells >> cell;
        cells.ignore();
      }
      rows.push_back(row);
    }
    return rows;
  }

  TemporaryFolder folder_;
};

/// C_m of Munk's moment at an angle of attack [rad], by the added mass in a file.
double munkPitch(const std::string& file, double attack, double area, double length) {
  const Matrix3 A = readFluidBody(file).added_mass.bottomRightCorner<3, 3>();
  const Vector3 v(std::cos(attack), 0, -std::sin(attack));
  return 2 * v.cross(Vector3(A * v)).y() / (area * length);
}

// Slip velocity on the windward side is V cos a: C_N = cos^2 a.
TEST_F(Polar, FlatPlateHasItsClosedForm) {
  const std::string plate = write(makeRectangularSheetMesh(2, 3, 200), true);
  const std::vector<Row> rows = polar(plate, {"--attack", "-30:60:30", "--law", "published"});
  ASSERT_EQ(rows.size(), 4u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double a = rows[i][kAttack] * kPi / 180, c = std::cos(a);
    const double side = (a > 0) - (a < 0);
    EXPECT_NEAR(rows[i][kAttack], -30 + 30.0 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(rows[i][kLift], side * c * c * c, 1e-8);
    EXPECT_NEAR(rows[i][kDrag], c * c * std::abs(std::sin(a)), 1e-8);
    EXPECT_NEAR(rows[i][kPitch], munkPitch(plate, a, 6, 2), 1e-8);
  }
}

// Surface integrals of the model over the smooth body: F / (rho/2), T / (rho/2) at V = 1.
TEST_F(Polar, ObliqueSpheroidAgreesWithQuadrature) {
  const std::string disc = write(makeEllipsoidMesh({1, 1, 0.2}, 5000));
  const Row row = polar(disc, {"--attack", "30", "--reference-area", "1", "--reference-length", "1",
                               "--law", "published"})[0];
  const double force_x = -0.03831223759085936, force_z = 2.1569881366057917,
               torque_y = 0.22698823654312306;
  const double c = std::cos(kPi / 6), s = 0.5;
  // Error of the facets of 5000 triangles; measured 3.9e-3.
  EXPECT_NEAR(row[kLift], force_x * s + force_z * c, 5e-3);
  EXPECT_NEAR(row[kDrag], -force_x * c + force_z * s, 5e-3);
  EXPECT_NEAR(row[kPitch], munkPitch(disc, kPi / 6, 1, 1) - torque_y, 5e-3);
}

TEST_F(Polar, SideSlipAndOtherAxesAreTheSameBodyTurned) {
  const TriangleMesh wing = moved(makeBoxMesh({1, 3, 0.2}, 800), {0.3, 0.4, 0.5});
  const std::vector<std::string> angles{"--attack", "20", "--side-slip", "-15"};
  const Row row = polar(write(wing), angles)[0];
  // Maps forward x to z, up z to -y.
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  std::vector<std::string> turned = angles;
  turned.insert(turned.end(), {"--forward", "z", "--up", "-y"});
  const Row same = polar(write(rotated(wing, turn)), turned)[0];
  for (int k = kLift; k <= kYaw; ++k) EXPECT_NEAR(same[k], row[k], 1e-8) << k;
  EXPECT_GT(std::abs(row[kSide]), 1e-3);
}

// Of a body in an ideal fluid, v x (A v): a slender one turns across the flow. The form law takes a
// part of it away where the flow separates.
TEST_F(Polar, HasMunksMoment) {
  BuildSettings settings;
  settings.name = "hull";
  settings.flow.max_panels = 0;
  const TriangleMesh hull = makeEllipsoidMesh({2, 0.5, 0.5}, 1280);
  settings.added_mass = Matrix6::Identity();  // alike along all axes: no moment
  const std::string bare = (folder_ / "bare.ambient").string();
  writeFluidBody(makeFluidBody(hull, settings), bare);
  settings.added_mass = Matrix6(Vector6(0, 0, 0, 0.2, 1.6, 1.6).asDiagonal());
  const std::string heavy = (folder_ / "heavy.ambient").string();
  writeFluidBody(makeFluidBody(hull, settings), heavy);
  const std::vector<std::string> more{
      "--attack", "10", "--reference-area", "1", "--reference-length", "4", "--law", "published"};
  const double a = 10 * kPi / 180;
  EXPECT_NEAR(polar(heavy, more)[0][kPitch] - polar(bare, more)[0][kPitch],
              2 * std::sin(a) * std::cos(a) * 1.4 / 4, 1e-6);
}

TEST_F(Polar, WindFromTheRightPushesToTheLeft) {
  const std::string ball = write(makeEllipsoidMesh({1, 1, 1}, 1280));
  const std::vector<Row> rows = polar(ball, {"--attack", "0", "--side-slip", "0:40:40"});
  for (const Row& row : rows) {
    // Drag of a ball turns with the flow: 1/2 of its silhouette.
    // Force across the flow comes from the facets, measured 6e-3.
    EXPECT_NEAR(row[kDrag], 0.5, 5e-3);
    EXPECT_NEAR(row[kSide], 0, 1e-2);
  }
  const std::string fin = write(makeBoxMesh({1, 0.02, 1}, 800));
  const Row side = polar(fin, {"--attack", "0", "--side-slip", "20", "--reference-area", "4",
                               "--reference-length", "1"})[0];
  EXPECT_LT(side[kSide], -0.1);
}

// Any length and density: a ball is the ball that it is printed beside.
TEST_F(Polar, DragOverReynoldsNumbersIsThatOfStokesToTheCrisis) {
  BuildSettings settings;
  settings.sphere_radius = 3;
  settings.added_mass = Matrix6::Identity();
  const std::string file = (folder_ / "ball.ambient").string();
  writeFluidBody(makeFluidBody(makeEllipsoidMesh({3, 3, 3}, 80), settings), file);
  const ProgramResult result = run(file, {"--reynolds", "1e-3:1e6:1"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "Reynolds number on D_A = sqrt(area/pi) = 6 m, C_D on 28.2743339 m^2\n");
  std::istringstream lines(result.output);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "Re,C_D,C_D_of_ball");
  double expected = 1e-3, reynolds = 0, drag = 0, ball = 0;
  while (lines >> reynolds && lines.ignore() >> drag && lines.ignore() >> ball) {
    EXPECT_NEAR(reynolds, expected, 1e-8 * expected);
    EXPECT_NEAR(drag, ball, 1e-8 * ball);
    if (expected < 1e-2) {
      EXPECT_NEAR(drag, 24 / reynolds, 1e-3 * drag);
    }
    expected *= 10;
  }
  EXPECT_NEAR(expected, 1e7, 1);  // ten rows
  EXPECT_LT(drag, 0.15);          // beyond the crisis
  const ProgramResult sheet = run(write(makeRectangularSheetMesh(2, 3, 200), true),
                                  {"--reynolds", "1:10", "--roughness", "1e-4"});
  EXPECT_EQ(sheet.errors, "ambient_preprocess: " + (folder_ / "body.ambient").string() +
                              ": has no area seen along --forward: give --reference-area\n");
}

TEST_F(Polar, BadAnglesAndAxesAreRefused) {
  const std::string file = write(makeBoxMesh({1, 1, 1}, 12));
  const auto refusal = [&](const std::vector<std::string>& more, int exit_code) {
    const ProgramResult result = run(file, more);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.output, "");
    const std::string beginning = "ambient_preprocess: ";
    EXPECT_EQ(result.errors.find(beginning), 0u) << result.errors;
    EXPECT_EQ(result.errors.back(), '\n');
    return result.errors.substr(beginning.size(), result.errors.size() - beginning.size() - 1);
  };
  expectRefusals(AMBIENT_COMMAND_REFUSALS, "options of polar",
                 [&](const std::vector<std::string>& more) { return refusal(more, 2); });
  EXPECT_EQ(refusal({"--speed", "1e200"}, 1),
            file +
                ": a coefficient at an angle of attack of -90 degrees "
                "is not finite: speed or reference is too large or too small");
}

}  // namespace
}  // namespace ambient
