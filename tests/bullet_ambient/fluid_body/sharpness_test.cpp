#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

FluidBody bodyOf(const test::Triangulation& mesh) {
  FluidBody body;
  body.name = "round";
  body.faces = test::faceTableOf(mesh);
  body.area = test::totalArea(body.faces);
  for (const Vector3& vertex : mesh.vertices)
    body.surface.vertices.insert(body.surface.vertices.end(), vertex.begin(), vertex.end());
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    body.surface.triangles.insert(body.surface.triangles.end(), triangle.begin(), triangle.end());
  return body;
}

TEST(Sharpness, OfASphereIsZeroForEveryTriangulation) {
  double before = 1;
  for (const int level : {1, 2, 3}) {
    const std::vector<double> s = computeSharpness(bodyOf(test::geodesicSphere(level)));
    const double largest = *std::max_element(s.begin(), s.end());
    EXPECT_LT(largest, before / 8) << level;  // area of the mesh slightly too small
    before = largest;
  }
  EXPECT_LT(before, 1e-5);
}

TEST(Sharpness, DoesNotDependOnTheScale) {
  const FluidBody body = bodyOf(test::geodesicEllipsoid({1, 2, 5}, 2));
  EXPECT_EQ(computeSharpness(scaled(body, 1024)), computeSharpness(body));
}

TEST(Sharpness, OfASpheroidIsThatOfItsCurvature) {
  // At the pole of an oblate spheroid both curvatures are b/a^2.
  const FluidBody body = bodyOf(test::geodesicEllipsoid({2, 2, 1}, 4));
  const std::vector<double> s = computeSharpness(body);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < body.faces.size(); ++i)
    if (body.faces.centroid_z[i] > 0.99) {
      sum += s[i];
      ++count;
    }
  const double x = 0.25 * std::sqrt(body.area / (4 * 3.14159265358979));
  const double root = (1 - x * x) / (1 + x * x);
  ASSERT_GT(count, 10);
  EXPECT_NEAR(sum / count, root * root, 0.02);
}

TEST(Sharpness, TakesVerticesAtOnePlaceForOne) {
  const FluidBody body = bodyOf(test::geodesicSphere(2));
  FluidBody apart = body;
  apart.surface.vertices.clear();
  for (std::size_t i = 0; i < body.surface.triangles.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(body.surface.triangles[i]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      apart.surface.vertices.push_back(body.surface.vertices[3 * vertex + axis]);
  }
  std::iota(apart.surface.triangles.begin(), apart.surface.triangles.end(), 0);
  EXPECT_EQ(computeSharpness(apart), computeSharpness(body));
}

TEST(Sharpness, IsOneOnTheHollowSideOfASheet) {
  FluidBody shell = bodyOf(test::geodesicSphere(2));
  const std::size_t count = shell.faces.size();
  for (std::size_t i = 0; i < count; ++i)
    shell.faces.add(-shell.faces.normal(i), shell.faces.centroid(i), shell.faces.area[i]);
  const std::vector<double> s = computeSharpness(shell);
  ASSERT_EQ(s.size(), 2 * count);
  EXPECT_LT(*std::max_element(s.begin(), s.begin() + static_cast<std::ptrdiff_t>(count)), 0.05);
  EXPECT_EQ(*std::min_element(s.begin() + static_cast<std::ptrdiff_t>(count), s.end()), 1);
}

TEST(Sharpness, IsOneOfFacesWithoutASurface) {
  FluidBody body = bodyOf(test::geodesicSphere(0));
  body.surface = {};
  EXPECT_EQ(computeSharpness(body), std::vector<double>(20, 1));
}

TEST(Sharpness, NeedsTheTrianglesOfTheFaces) {
  FluidBody body = bodyOf(test::geodesicSphere(0));
  body.surface.triangles.resize(27);
  EXPECT_EQ(test::refusalOf<std::invalid_argument>([&] { computeSharpness(body); }),
            "fluid body 'round': number of its faces is 20, must be that of the triangles of its "
            "surface, or twice that of a sheet's, for the form law");
}

TEST(FormLawFaces, TakeAKnownSharpnessWithoutASurface) {
  FluidBody body = bodyOf(test::geodesicSphere(1));
  body.faces.sharpness.assign(body.faces.size(), 0.25);
  body.surface = {};
  EXPECT_EQ(formLawFaces(body, {}).sharpness, body.faces.sharpness);
}

}  // namespace
}  // namespace ambient
