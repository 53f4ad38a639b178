#include "preprocess/mesh/import/mesh_import.h"

#include <gtest/gtest.h>

#include <csignal>
#include <limits>

#include "preprocess/mesh/import/scene_triangles.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/preprocess/mesh/mesh_import_fixture.h"

namespace ambient {
namespace {

constexpr double kSingle = std::numeric_limits<float>::epsilon();  // rounding in assimp

TEST_F(MeshImport, ReadsTheCommonFormatsAlike) {
  const TriangleMesh cone = makeConeMesh(0.3, 0.7, 200);
  const MeshProperties exact = computeMassProperties(cone);
  for (const std::filesystem::path& file :
       {write("cone.obj", objText(cone)), write("cone ascii.stl", asciiStlText(cone)),
        write("cone.stl", binaryStlText(cone)), write("cone.ply", plyText(cone))}) {
    const ImportedMesh imported = importMesh(file);
    EXPECT_EQ(imported.mesh.vertexCount(), cone.vertexCount()) << file;
    EXPECT_EQ(imported.mesh.triangleCount(), cone.triangleCount()) << file;
    EXPECT_TRUE(imported.warnings.empty()) << file;
    const MeshProperties read = propertiesOf(file);
    EXPECT_NEAR(read.volume / exact.volume, 1, 10 * kSingle) << file;
    EXPECT_LT((read.uniform.centre - exact.uniform.centre).norm(), kSingle) << file;
  }
}

TEST_F(MeshImport, ScalesInDouble) {
  const auto file = write("tetrahedron.obj", objText(unitTetrahedron()));
  const double millimetre = 1e-3;
  EXPECT_DOUBLE_EQ(propertiesOf(file, millimetre).volume, 1e-9 / 6);
}

TEST_F(MeshImport, NodesPlaceTheirMeshes) {
  const auto file = folder_ / "scene with nodes.gltf";
  // The parent doubles its child, which is moved by 10 along z; both hold the mesh.
  writeGltf(file, unitTetrahedron(),
            R"([{"mesh":0,"children":[1],"scale":[2,2,2]},{"mesh":0,"translation":[0,0,10]}])");
  const MeshProperties both = propertiesOf(file);
  EXPECT_NEAR(both.volume, 2 * 8.0 / 6, 10 * kSingle);
  EXPECT_NEAR(both.uniform.centre.z(), 0.5 + 20.0 / 2, 20 * kSingle);
}

TEST_F(MeshImport, MirroringNodesKeepNormalsOutward) {
  const auto file = folder_ / "mirrored.gltf";
  writeGltf(file, unitTetrahedron(), R"([{"mesh":0,"scale":[1,-1,1]}])");
  const CheckedMesh checked =
      requireSound(checkMesh(importMesh(file).mesh, "mirrored"), "mirrored");
  EXPECT_TRUE(checked.warnings.empty());
  EXPECT_NEAR(computeMassProperties(checked.mesh).uniform.centre.y(), -0.25, kSingle);
}

TEST_F(MeshImport, SubMeshesAreWelded) {
  // A cube of two objects and two materials with a doubled seam, quads and a pentagon.
  const auto file = write("cube.obj",
                          "o bottom\nusemtl a\n"
                          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                          "f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\n"
                          "o top\nusemtl b\n"
                          "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 0 0 0\nv 1 1 0\nv 0 1 0\n"
                          "f 9 10 11 12\nf 11 14 15 12\nf 12 15 13 9\n");
  EXPECT_EQ(importMesh(file).mesh.vertexCount(), 8);
  const MeshProperties cube = propertiesOf(file);
  EXPECT_NEAR(cube.volume, 1, 10 * kSingle);
}

TEST_F(MeshImport, VerticesAreWeldedWithinAMillionthOfTheSize) {
  const double size = 1000;  // diagonal of the bounding box
  const auto stl = [&](double gap) {
    TriangleMesh mesh = scaled(unitTetrahedron(), size / std::sqrt(3.0));
    const std::string text = asciiStlText(mesh);
    mesh.vertices(0, 0) -= gap;
    const std::string other = asciiStlText(mesh);
    // Takes the first facet from a mesh with a moved corner, the others from the original.
    const std::string mark = "endfacet\n";
    return other.substr(0, other.find(mark)) + text.substr(text.find(mark));
  };
  EXPECT_EQ(importMesh(write("closed.stl", stl(0.5 * kWeldTolerance * size))).mesh.vertexCount(),
            4);
  EXPECT_EQ(importMesh(write("open.stl", stl(2 * kWeldTolerance * size))).mesh.vertexCount(), 5);
}

TEST_F(MeshImport, ConcavePolygonsAreDividedWithoutOverlap) {
  // An L-shaped prism: two hexagons and six rectangles; volume 3.
  const auto file =
      write("l.obj",
            "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
            "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
            "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n"
            "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n");
  const MeshProperties prism = propertiesOf(file);
  EXPECT_NEAR(prism.volume, 3, 10 * kSingle);
  EXPECT_NEAR(prism.area, 2 * 3 + 8, 20 * kSingle);
}

TEST_F(MeshImport, PointsAndLinesAreLeftOutWithAWarning) {
  const auto file = write("mixed.obj", objText(unitTetrahedron()) + "l 1 2\nl 2 3\n");
  const ImportedMesh imported = importMesh(file);
  EXPECT_EQ(imported.mesh.triangleCount(), 4);
  ASSERT_EQ(imported.warnings.size(), 1u);
  EXPECT_EQ(imported.warnings[0], file.string() + ": 2 points and lines were left out");
}

TEST_F(MeshImport, TrianglesThatVanishAreLeftOutWithAWarning) {
  TriangleMesh mesh = unitTetrahedron();
  mesh.vertices.conservativeResize(3, 5);
  mesh.vertices.col(4) << 1e-8, 0, 0;
  mesh.triangles.conservativeResize(3, 6);
  mesh.triangles.col(0) << 4, 2, 1;  // face 0 2 1, with a sliver along its side 0 2
  mesh.triangles.col(4) << 0, 2, 4;
  mesh.triangles.col(5) << 0, 4, 1;
  const auto file = write("sliver.obj", objText(mesh));
  const ImportedMesh imported = importMesh(file);
  EXPECT_EQ(imported.mesh.triangleCount(), 4);
  EXPECT_NEAR(propertiesOf(file).volume, 1.0 / 6, kSingle);
  ASSERT_EQ(imported.warnings.size(), 1u);
  EXPECT_EQ(imported.warnings[0], file.string() +
                                      ": 2 of 6 triangles are shorter than 1e-06 of its size and "
                                      "were left out");
}

TEST_F(MeshImport, MeshesFarFromTheOriginAreWarnedAbout) {
  const TriangleMesh mesh = scaled(makeBoxMesh({1, 1, 1}, 12), 0.5);
  EXPECT_TRUE(importMesh(write("near.obj", objText(moved(mesh, {100, 0, 0})))).warnings.empty());
  const ImportedMesh far = importMesh(write("far.obj", objText(moved(mesh, {1e5, 0, 0}))));
  ASSERT_EQ(far.warnings.size(), 1u);
  EXPECT_NE(far.warnings[0].find("single precision resolves only 0.00688 of its size"),
            std::string::npos)
      << far.warnings[0];
  const std::string file = write("far.obj", objText(moved(mesh, {1e6, 0, 0})));
  const std::string message = messageOf([&] { importMesh(file); });
  EXPECT_EQ(message.find(file + ": lies "), 0u) << message;
  EXPECT_NE(message.find("resolves only 0.0688 of its size: move it to the origin"),
            std::string::npos)
      << message;
}

TEST_F(MeshImport, MissingAndForeignFilesAreRefused) {
  EXPECT_EQ(refusal(folder_ / "no such.obj"), "no such file");
  EXPECT_EQ(refusal(folder_.path()), "is a directory, not a mesh file");
  EXPECT_EQ(refusal(write("empty.obj", "")), "the file is empty");
  const std::string unreadable = "cannot be read as a mesh: ";
  for (const auto& file :
       {write("text.xyz", "hello"), write("noise.stl", "hello"), write("noise.ply", "hello"),
        write("noise.gltf", "{]"), write("noise.glb", "hello"), write("no extension", "hello")}) {
    EXPECT_EQ(refusal(file).substr(0, unreadable.size()), unreadable) << file;
  }
}

// Files that crash assimp 5.2 or keep it from returning.
TEST_F(MeshImport, DamagedFilesThatBringDownTheirReaderAreRefused) {
  const std::string whole = plyText(unitTetrahedron());
  const std::size_t end = whole.find("end_header");
  for (const std::string& torn :
       {whole.substr(0, end), whole.substr(0, end) + "end_headers\n", "PLY\nnoise " + whole}) {
    EXPECT_EQ(refusal(write("torn.ply", torn)),
              "cannot be read as a mesh: the header of the PLY file is damaged");
  }
  const std::string short_of_faces =
      "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0\n1 0\n0 1 0\n3 0 2 1\n3 0 1 3\n; 0 3 2\n3 1 2 1\n";
  EXPECT_NE(refusal(write("short.off", short_of_faces)), "");
}

TEST_F(MeshImport, FilesWithoutTrianglesAreRefused) {
  for (const auto& file : {write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
                           write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"),
                           write("noise.obj", "hello hello hello\n")}) {
    EXPECT_EQ(refusal(file), "there are no triangles") << file;
  }
}

TEST_F(MeshImport, FacesOfMissingVerticesAreRefused) {
  TriangleMesh mesh = unitTetrahedron();
  mesh.triangles(1, 2) = 99;
  EXPECT_EQ(refusal(write("index.ply", plyText(mesh))),
            "a face refers to vertex 99, but there are 4 vertices");
}

TEST_F(MeshImport, CoordinatesThatAreNotFiniteReachTheCheck) {
  std::string text = objText(unitTetrahedron());
  text.replace(text.find("v 1 0 0"), 7, "v nan 0 0");
  const auto file = write("nan.obj", text);
  EXPECT_EQ(messageOf([&] {
              requireSound(checkMesh(importMesh(file).mesh, "nan.obj"), "nan.obj");
            }).substr(0, 16),
            "nan.obj: vertex ");
}

TEST_F(MeshImport, ImpossibleScalesAreRefused) {
  const auto file = write("tetrahedron.obj", objText(unitTetrahedron()));
  EXPECT_EQ(refusal(file, 0), "scale = 0 is not positive and finite");
  EXPECT_EQ(refusal(file, -1), "scale = -1 is not positive and finite");
  EXPECT_EQ(refusal(file, std::nan("")), "scale = nan is not positive and finite");
}

ChildResult runShell(const std::string& text) { return runChild({"sh", "-c", text}); }

TEST(ChildProcess, ReturnsWhatTheProgramWrites) {
  EXPECT_EQ(runShell("exit 0").output, "");
  const std::string zeros = runShell("head -c 3000000 /dev/zero").output;  // exceeds a pipe
  EXPECT_EQ(zeros, std::string(3'000'000, '\0'));
}

TEST(ChildProcess, PassesArgumentsAsTheyAre) {
  const std::string word = "a b; echo $HOME '\"*";
  EXPECT_EQ(runChild({"printf", "%s", word}).output, word);
}

TEST(ChildProcess, TellsHowTheProgramEnded) {
  EXPECT_EQ(runShell("exit 3").exit_code, 3);
  EXPECT_EQ(runShell("kill -SEGV $$").signal, SIGSEGV);
  EXPECT_EQ(runShell("ulimit -S -t 1; while :; do :; done").signal, SIGXCPU);
}

TEST(ChildProcess, ProgramsThatAreMissingAreNamed) {
  EXPECT_EQ(messageOf([] { runChild({"no_such_program"}); }),
            "the program no_such_program could not be started: it is neither beside this program "
            "nor on the PATH");
}

}  // namespace
}  // namespace ambient
