#include "preprocess/mesh_report/potential_picture.h"

#include <gtest/gtest.h>

#include <set>

#include "preprocess/mesh/primitives.h"

namespace ambient {
namespace {

using Potential = Eigen::Matrix<double, Eigen::Dynamic, 6>;

int countOf(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

/// The fills of all triangles.
std::set<std::string> fillsOf(const std::string& picture) {
  const std::string mark = "z\" fill=\"";
  std::set<std::string> fills;
  for (std::size_t at = picture.find(mark); at != std::string::npos;
       at = picture.find(mark, at + 1)) {
    fills.insert(picture.substr(at + mark.size(), 7));
  }
  return fills;
}

bool isGrey(const std::string& fill) {
  return fill.substr(1, 2) == fill.substr(3, 2) && fill.substr(3, 2) == fill.substr(5, 2);
}

TEST(PotentialPicture, ShowsHalfOfABoxSixTimes) {
  const TriangleMesh box = makeBoxMesh({1, 2, 3}, 300);
  const std::string picture = potentialPicture(box, Potential::Zero(box.vertexCount(), 6), false);
  EXPECT_EQ(picture.find("<svg "), 0u);
  EXPECT_EQ(countOf(picture, "z\" fill="), 6 * static_cast<int>(box.triangleCount()) / 2);
  EXPECT_EQ(countOf(picture, "<g "), countOf(picture, "</g>"));
  EXPECT_EQ(picture.find("nan"), std::string::npos);
}

TEST(PotentialPicture, ShowsBothSidesOfASheet) {
  const TriangleMesh sheet = makeRectangularSheetMesh(1, 2, 100);
  const std::string picture =
      potentialPicture(sheet, Potential::Zero(sheet.vertexCount(), 6), true);
  EXPECT_EQ(countOf(picture, "z\" fill="), 6 * static_cast<int>(sheet.triangleCount()));
}

TEST(PotentialPicture, RoundingIsGreyAndWhatIsAboveIsColoured) {
  const TriangleMesh ball = makeEllipsoidMesh({0.01, 0.01, 0.01}, 320);
  Potential potential = Potential::Zero(ball.vertexCount(), 6);
  potential.col(0) = 1e-9 * ball.vertices.row(0).transpose();
  for (const std::string& fill : fillsOf(potentialPicture(ball, potential, false)))
    EXPECT_TRUE(isGrey(fill)) << fill;
  potential.col(3) = -0.5 * ball.vertices.row(0).transpose();
  const std::string picture = potentialPicture(ball, potential, false);
  int red = 0, blue = 0;
  for (const std::string& fill : fillsOf(picture)) {
    const std::string r = fill.substr(1, 2), b = fill.substr(5, 2);
    red += static_cast<int>(r > b);
    blue += static_cast<int>(r < b);
  }
  EXPECT_GT(red, 5);
  EXPECT_GT(blue, 5);
  EXPECT_NE(picture.find("-0.005 to 0.005 m²/s"), std::string::npos);
}

}  // namespace
}  // namespace ambient
