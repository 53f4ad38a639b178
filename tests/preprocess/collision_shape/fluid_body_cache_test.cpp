#include "preprocess/collision_shape/fluid_body_cache.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/fluid_body_writer.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using test::coarse;
using test::differenceOf;

namespace fs = std::filesystem;

btVector3 sizes(double x, double y, double z) { return toBullet(Vector3(x, y, z)); }

std::vector<fs::path> filesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

// Corners of a wedge.
const std::vector<btVector3> kWedge{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}, {3, 0, 1}};

std::unique_ptr<btConvexHullShape> wedge(double factor = 1) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const btVector3& point : kWedge) hull->addPoint(point * static_cast<btScalar>(factor));
  return hull;
}

TEST(FluidBodyCache, EqualShapesAreOneWhereverTheyAre) {
  FluidBodyCache cache(coarse());
  const btBoxShape first(sizes(0.5, 1, 2)), same(sizes(0.5, 1, 2)), other(sizes(0.5, 1, 2.1));
  const auto body = cache.fluidBody(first);
  EXPECT_EQ(cache.fluidBody(same), body);
  EXPECT_NE(cache.fluidBody(other), body);
  EXPECT_EQ(cache.counts().made, 2);
  EXPECT_EQ(cache.fluidBody(*wedge()), cache.fluidBody(*wedge()));
  EXPECT_NE(cache.fluidBody(*wedge()), cache.fluidBody(*wedge(1.05)));
  EXPECT_EQ(cache.counts().made, 3);  // the larger wedge is the smaller one, scaled
}

// Faces that follow from the surface are not kept; whoever reads them gets them.
TEST(FluidBodyCache, FacesAreThoseOfTheSurface) {
  const btCylinderShapeZ shape(sizes(0.3, 0.3, 0.5));
  FluidBodyCache cache;
  const std::shared_ptr<const FluidBody> kept = cache.fluidBody(shape);
  EXPECT_EQ(kept->faces.size(), 0u);
  const FaceTable whole = makeFluidBody(shape).faces, faces = facesOf(*kept);
  ASSERT_EQ(faces.size(), 2 * kept->surface.vertices.size() / 3 - 4);
  double area = 0;
  Vector3 sum(0, 0, 0);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    area += faces.area[i];
    sum += faces.area[i] * faces.normal(i);
    EXPECT_GT(faces.normal(i).dot(faces.centroid(i)), 0);  // convex, about its middle
  }
  EXPECT_NEAR(area, kept->area, 1e-12);
  EXPECT_LT(sum.norm(), 1e-14);
  EXPECT_EQ(faces.size(), whole.size());
  EXPECT_EQ(decodeFluidBody(encodeFluidBody(*kept, ""), "").faces.area, faces.area);

  const Twist x{{1, 2, 3}, {3, -1, 2}};
  FlowSettings published;
  published.law = PressureLaw::kPublished;
  const auto loads = makeSurfaceLoads(kept, water(), published);
  ASSERT_TRUE(loads);
  EXPECT_EQ(loads->faces(), static_cast<int>(faces.size()));
  FluidBody own = *kept;
  own.faces = faces;
  own.omits_faces = false;
  const auto expected =
      makeSurfaceLoads(std::make_shared<const FluidBody>(own), water(), published);
  EXPECT_EQ(loads->load(x).vector(), expected->load(x).vector());
  published.own_law = [&](const auto& body, const auto&) {
    EXPECT_EQ(body->faces.size(), faces.size());
    return nullptr;
  };
  makeSurfaceLoads(kept, water(), published);
  own.faces = {};  // not left out: there are none
  EXPECT_EQ(facesOf(own).size(), 0u);
  EXPECT_FALSE(makeSurfaceLoads(std::make_shared<const FluidBody>(own), water(), FlowSettings()));
}

// Tables scale with size like the added mass; spheres use a built-in table.
TEST(FluidBodyCache, MakesWaterlineTablesOfAllButSpheres) {
  const TemporaryFolder folder;
  CollisionShapeSettings settings = coarse();
  settings.waterline_subdivisions = 1;
  FluidBodyCache cache(settings, folder.path());
  const auto box = cache.fluidBody(btBoxShape(sizes(0.5, 0.5, 0.5)));
  ASSERT_EQ(box->waterline.subdivisions, 1);
  EXPECT_FALSE(box->waterline.corrections.empty());
  const auto large = cache.fluidBody(btBoxShape(sizes(1, 1, 1)));
  EXPECT_EQ(cache.counts().made, 1);
  EXPECT_NEAR(large->waterline.corrections[0](3, 3) / box->waterline.corrections[0](3, 3), 8, 1e-5);
  EXPECT_TRUE(cache.fluidBody(btSphereShape(1))->waterline.empty());
  // Bodies without a table have a separate file.
  EXPECT_TRUE(FluidBodyCache(coarse(), folder.path())
                  .fluidBody(btBoxShape(sizes(1, 1, 1)))
                  ->waterline.empty());
  settings.waterline_subdivisions = 17;
  EXPECT_NE(messageOf([&] {
              FluidBodyCache(settings).fluidBody(btBoxShape(sizes(1, 1, 1)));
            }).find("waterline subdivisions = 17 is not between 0 (no table) and 16"),
            std::string::npos);
}

// Compares with makeFluidBody(); the cache rounds proportions to a millionth.
TEST(FluidBodyCache, GivesWhatTheShapeIs) {
  FluidBodyCache cache(coarse());
  btBoxShape box(sizes(0.15, 0.21, 0.33));
  const auto body = cache.fluidBody(box);
  const FluidBody direct = makeFluidBody(box, coarse());
  EXPECT_EQ(body->name.substr(0, 4), "Box ");
  EXPECT_EQ(cache.find(body->name), body);
  EXPECT_EQ(cache.find("Box"), nullptr);
  EXPECT_EQ(body->origin, Vector3::Zero());
  EXPECT_NEAR(body->volume / direct.volume, 1, 3e-6);
  const double size = 1 / 0.33;
  EXPECT_LT(differenceOf(scaleShape(body->added_mass, size), scaleShape(direct.added_mass, size)),
            1e-5);
  EXPECT_LT((extentsOf(*body) - extentsOf(direct)).norm(), 1e-6);
}

// As after resetSimulation of a robot: what a known hull costs is reading its numbers.
TEST(FluidBodyCache, AKnownHullIsFoundByItsNumbersAsTheyAre) {
  constexpr int kPoints = 1000;
  btConvexHullShape hull;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = i, z = 2.0 * i / kPoints - 1, radius = std::sqrt(1 - z * z);
    hull.addPoint(sizes(radius * std::cos(angle), radius * std::sin(angle), z), false);
  }
  FluidBodyCache cache(coarse());
  const auto body = cache.fluidBody(hull);
  const std::size_t bytes = test::allocatedBytes();
  EXPECT_EQ(cache.fluidBody(hull), body);
  constexpr double kOfPoints = 3.0 * kPoints * sizeof(double);
  EXPECT_LT(static_cast<double>(test::allocatedBytes() - bytes), 8 * kOfPoints);
}

TEST(FluidBodyCache, KnowsHullsByTheirLocalScaling) {
  FluidBodyCache cache(coarse());
  const auto own = wedge(), scaled_hull = wedge(), stretched = wedge();
  scaled_hull->setLocalScaling(sizes(0.3, 0.3, 0.3));
  stretched->setLocalScaling(sizes(1, 1, 2));
  const auto body = cache.fluidBody(*own);
  const auto small = cache.fluidBody(*scaled_hull);
  EXPECT_EQ(cache.counts().made, 1);
  EXPECT_NEAR(small->volume / body->volume, 0.027, 1e-7);
  cache.fluidBody(*stretched);
  EXPECT_EQ(cache.counts().made, 2);
}

TEST(FluidBodyCache, WhatAShapeGetsDoesNotDependOnThoseBefore) {
  const btBoxShape small(sizes(0.1, 0.2, 0.3)), large(sizes(0.2, 0.4, 0.6));
  FluidBodyCache forwards(coarse()), backwards(coarse());
  forwards.fluidBody(small);
  backwards.fluidBody(large);
  EXPECT_EQ(encodeFluidBody(*forwards.fluidBody(large), ""),
            encodeFluidBody(*backwards.fluidBody(large), ""));
  EXPECT_EQ(encodeFluidBody(*forwards.fluidBody(small), ""),
            encodeFluidBody(*backwards.fluidBody(small), ""));
}

TEST(FluidBodyCache, CompoundsAreKnownByTheirChildren) {
  const auto compound = [](double gap) {
    auto shape = std::make_unique<btCompoundShape>();
    static btSphereShape ball(1);
    shape->addChildShape(btTransform(btQuaternion::getIdentity(), sizes(-1 - gap, 0, 0)), &ball);
    shape->addChildShape(btTransform(btQuaternion::getIdentity(), sizes(1 + gap, 0, 0)), &ball);
    return shape;
  };
  FluidBodyCache cache(coarse());
  const auto body = cache.fluidBody(*compound(1));
  EXPECT_EQ(cache.fluidBody(*compound(1)), body);
  EXPECT_NE(cache.fluidBody(*compound(2)), body);
}

TEST(FluidBodyCache, RefusesAsOftenAsItIsAsked) {
  FluidBodyCache cache(coarse());
  const btStaticPlaneShape plane(sizes(0, 0, 1), 0);
  const btBoxShape flat(sizes(1, 0, 1));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(messageOf([&] { cache.fluidBody(plane); }),
              "STATICPLANE: a plane (STATICPLANE) is unbounded and cannot move in a fluid");
    const std::string message = messageOf([&] { cache.fluidBody(flat); });
    EXPECT_EQ(message.rfind("Box: ", 0), 0u) << message;
  }
}

TEST(FluidBodyCache, ThreadsThatAskForOneShapeMakeItOnce) {
  FluidBodyCache cache(coarse());
  std::vector<std::thread> threads;
  std::vector<std::shared_ptr<const FluidBody>> bodies(4);
  for (auto& body : bodies) {
    threads.emplace_back([&cache, &body] { body = cache.fluidBody(*wedge()); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& body : bodies) EXPECT_EQ(body, bodies[0]);
  EXPECT_EQ(cache.counts().made, 1);
}

TEST(FluidBodyCache, ExpectedShapesAreMadeSideBySideAsOneByOne) {
  std::vector<std::string> said, said_alone;
  const auto settings = [](std::vector<std::string>& lines) {
    CollisionShapeSettings result = coarse();
    result.strict = true;
    result.flow.threads = 3;
    result.report = [&lines](const std::string& line) {
      if (line.rfind("making ", 0) != 0) lines.push_back(line);  // of work that takes long
    };
    return result;
  };
  FluidBodyCache cache(settings(said)), alone(settings(said_alone));
  std::vector<std::unique_ptr<btCollisionShape>> hulls;
  for (const double stretch : {1.0, 1.3, 1.7}) {
    hulls.push_back(wedge());
    hulls.back()->setLocalScaling(sizes(stretch, 1, 1));
  }
  test::GImpactMesh open(withoutTriangle(scaled(unitTetrahedron(), 10), 0));
  const btBoxShape box(sizes(1, 2, 3));
  FluidBodySource::Expected expected{{nullptr, &box, &open.shape, hulls[0].get()},
                                     [](std::size_t) { return "body 'crane', 3 of 14"; }};
  for (const auto& hull : hulls) expected.shapes.push_back(hull.get());
  const Expecting expecting(cache, expected);
  EXPECT_EQ(cache.counts().made, 0);
  cache.fluidBody(*hulls[1]);
  EXPECT_EQ(cache.counts().made, 4) << "three wedges and the mesh; the box is made in no time";
  for (const auto& hull : hulls)
    EXPECT_EQ(encodeFluidBody(*cache.fluidBody(*hull), ""),
              encodeFluidBody(*alone.fluidBody(*hull), ""));
  const std::string refusal = messageOf([&] { alone.fluidBody(open.shape); });
  EXPECT_FALSE(refusal.empty());
  EXPECT_EQ(messageOf([&] { cache.fluidBody(open.shape); }), refusal);
  EXPECT_EQ(cache.counts().made, 4) << "what was refused is not tried again at once";
  EXPECT_EQ(messageOf([&] { cache.fluidBody(open.shape); }), refusal);
  EXPECT_EQ(said, said_alone);
}

TEST(FluidBodyCache, AnotherRunReadsWhatThisOneMade) {
  const TemporaryFolder folder;
  FluidBodyCache first(coarse(), folder / "kept"), second(coarse(), folder / "kept");
  const btBoxShape box(sizes(0.5, 1, 2)), twice(sizes(1, 2, 4));
  const auto made = first.fluidBody(box);
  const auto read = second.fluidBody(box);
  EXPECT_EQ(second.counts().made, 0);
  EXPECT_EQ(second.counts().read, 1);
  EXPECT_EQ(encodeFluidBody(*read, ""), encodeFluidBody(*made, ""));
  ASSERT_EQ(read->added_mass_parts.size(), made->added_mass_parts.size());
  for (std::size_t i = 0; i < made->added_mass_parts.size(); ++i) {
    EXPECT_EQ(read->added_mass_parts[i].centre, made->added_mass_parts[i].centre);
    EXPECT_EQ(read->added_mass_parts[i].spread, made->added_mass_parts[i].spread);
    EXPECT_EQ(read->added_mass_parts[i].inertia, made->added_mass_parts[i].inertia);
  }
  second.fluidBody(twice);
  EXPECT_EQ(second.counts().made, 0);
  EXPECT_EQ(filesIn(folder / "kept").size(), 1u);
  CollisionShapeSettings finer = coarse();
  finer.faces = 500;
  FluidBodyCache third(finer, folder / "kept");
  third.fluidBody(box);
  EXPECT_EQ(third.counts().made, 1) << "other settings";
  FluidBodyCache usual({}, folder / "usual"), again({}, folder / "usual");
  usual.fluidBody(box);
  again.fluidBody(box);
  EXPECT_EQ(again.counts().made, 0) << "default settings";
}

std::string bytesOfBoxes(FluidBodyCache& cache) {
  std::string bytes;
  for (int i = 0; i < 40; ++i)
    bytes += encodeFluidBody(*cache.fluidBody(btBoxShape(sizes(1, 1 + 0.05 * i, 3))), "");
  return bytes;
}

/// Starts a process that fills the user's folder below `home` as soon as `start` is closed. It ends
/// with 0 if it gets what is expected and nothing is said.
pid_t startFilling(const fs::path& home, const int* start, const std::string& expected) {
  const pid_t child = fork();
  if (child != 0) return child;
  setenv("XDG_CACHE_HOME", home.c_str(), 1);
  unsetenv("BULLET_AMBIENT_CACHE");
  int said = 0;
  CollisionShapeSettings settings = coarse();
  settings.report = [&said](const std::string&) { ++said; };
  FluidBodyCache cache(settings, userBodyFolder().path);
  char none = 0;
  close(start[1]);
  const bool has_begun = read(start[0], &none, 1) == 0;
  _exit(has_begun && bytesOfBoxes(cache) == expected && said == 0 ? 0 : 1);
}

TEST(FluidBodyCache, TwoProcessesFillOneFolderAtOnce) {
  const TemporaryFolder home;
  FluidBodyCache alone(coarse());
  const std::string expected = bytesOfBoxes(alone);
  int start[2], status = 0;
  ASSERT_EQ(pipe(start), 0);
  const pid_t children[] = {startFilling(home.path(), start, expected),
                            startFilling(home.path(), start, expected)};
  close(start[0]);
  close(start[1]);
  for (const pid_t child : children) {
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  FluidBodyCache later(coarse(), home / "bullet_ambient");
  EXPECT_EQ(bytesOfBoxes(later), expected);
  EXPECT_EQ(later.counts().read, 40);
  EXPECT_EQ(filesIn(home / "bullet_ambient").size(), 40u);
}

TEST(FluidBodyCache, KeepsOnlyWhatTookLong) {
  const TemporaryFolder folder;
  FluidBodyCache cache(coarse(), {folder / "kept", std::chrono::hours(1)});
  cache.fluidBody(btBoxShape(sizes(0.5, 1, 2)));
  EXPECT_EQ(cache.counts().made, 1);
  EXPECT_TRUE(folder.empty());
}

TEST(FluidBodyCache, TellsSolversApart) {
  CollisionShapeSettings dense = coarse(), hierarchical = coarse();
  dense.flow.solver = FlowSolverKind::Dense;
  hierarchical.flow.solver = FlowSolverKind::Hierarchical;
  EXPECT_NE(describeCollisionShape(*wedge(), dense).settings,
            describeCollisionShape(*wedge(), hierarchical).settings);
}

TEST(FluidBodyCache, MakesAnewWhatIsDamagedOrForeign) {
  const TemporaryFolder folder;
  const btBoxShape box(sizes(0.5, 1, 2));
  FluidBodyCache(coarse(), folder.path()).fluidBody(box);
  ASSERT_EQ(filesIn(folder.path()).size(), 1u);
  const fs::path file = filesIn(folder.path())[0];
  const FluidBody made = readFluidBody(file);
  const auto expectMadeAnew = [&](const char* what) {
    FluidBodyCache cache(coarse(), folder.path());
    cache.fluidBody(box);
    EXPECT_EQ(cache.counts().made, 1) << what;
    EXPECT_EQ(encodeFluidBody(readFluidBody(file), ""), encodeFluidBody(made, "")) << what;
  };
  fs::resize_file(file, 100);
  expectMadeAnew("cut off");
  std::ofstream(file, std::ios::trunc) << "something else";
  expectMadeAnew("foreign");
  FluidBody older = made;
  older.provenance.generator = "bullet_ambient 0.0.1, solver revision 1";
  writeFluidBody(older, file);
  expectMadeAnew("older");
}

TEST(FluidBodyCache, ThatCannotWriteSaysSoAndGoesOn) {
  const TemporaryFolder folder;
  std::ofstream(folder / "kept") << "a file where the folder should be";
  CollisionShapeSettings settings = coarse();
  std::vector<std::string> said;
  settings.report = [&](const std::string& text) { said.push_back(text); };
  FluidBodyCache cache(settings, folder / "kept");
  EXPECT_NE(cache.fluidBody(btBoxShape(sizes(0.5, 1, 2))), nullptr);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].rfind("the fluid body is not kept: ", 0), 0u) << said[0];
}

}  // namespace
}  // namespace ambient
