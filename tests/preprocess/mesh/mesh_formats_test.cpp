#include <gtest/gtest.h>

#include <csignal>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

// Features of single file formats, and the meshes read from them.

const std::string kUnreadable = "cannot be read as a mesh: ";

/// COLLADA text of a tetrahedron of volume 1/6 with different extents along x, y and z.
std::string colladaText(const std::string& up_axis, const std::string& libraries) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>)" +
         up_axis + "</up_axis></asset>" + libraries + R"(
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 2 0 0 0 0.5</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g">
<bind_material><technique_common><instance_material symbol="m" target="#material"/>
</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

TEST_F(MeshImport, ColladaKeepsTheAxesOfTheFileWhateverIsUp) {
  const Eigen::Vector3d extents(1, 2, 0.5);
  for (const char* const up : {"X_UP", "Y_UP", "Z_UP"}) {
    const ImportedMesh imported = importMesh(write("thing.dae", colladaText(up, "")));
    EXPECT_EQ(imported.mesh.extents(), extents) << up;
    EXPECT_EQ(imported.mesh.vertices.maxCoeff(), 2) << up;
    EXPECT_TRUE(imported.warnings.empty()) << up;
  }
}

TEST_F(MeshImport, ColladaImagesNeedNoSource) {
  const std::string libraries = R"(
<library_images><image id="i"><init_from/></image></library_images>
<library_materials><material id="material"><instance_effect url="#e"/></material></library_materials>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>f</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse><texture texture="t" texcoord="u"/></diffuse></lambert>
</technique></profile_COMMON></effect></library_effects><library_images/>)";
  const auto file = write("thing.dae", colladaText("Y_UP", libraries));
  EXPECT_NEAR(propertiesOf(file).volume, 1.0 / 6, 1e-7);
}

std::string dxfText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "0\nSECTION\n2\nENTITIES\n";
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    text << "0\n3DFACE\n8\nlayer\n";
    for (int k = 0; k < 4; ++k) {  // repeats the third corner
      const Eigen::Vector3d p = mesh.corner(t, std::min(k, 2));
      for (int c = 0; c < 3; ++c) text << 10 * (c + 1) + k << "\n" << p[c] << "\n";
    }
  }
  text << "0\nENDSEC\n0\nEOF\n";
  return text.str();
}

TEST_F(MeshImport, AxesThatAFormatTurnsAreToldOf) {
  TriangleMesh mesh = unitTetrahedron();
  mesh.vertices.col(3) *= 2;
  const auto file = write("thing.dxf", dxfText(mesh));
  const ImportedMesh imported = importMesh(file);
  EXPECT_EQ(imported.mesh.extents(), Eigen::Vector3d(1, 2, 1));
  ASSERT_EQ(imported.warnings.size(), 1u);
  EXPECT_EQ(imported.warnings[0], file.string() +
                                      ": files of this format are turned when they are read: "
                                      "(x, y, z) becomes (x, z, -y)");
}

TEST_F(MeshImport, ObjFacesNeedNotHaveWhatTheyReferTo) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\n";
  for (const char* const faces :
       {"f 1//1 3//1 2//1\nf 1//1 2//1 4//1\nf 1//1 4//1 3//1\nf 2//1 3//1 4//1\n",
        "f 1/1/1 3/1/1 2/1/1\nf 1/1/1 2/1/1 4/1/1\nf 1/1/1 4/1/1 3/1/1\nf 2/1/1 3/1/1 4/1/1\n",
        "f 1/0/1 3/0/1 2/0/1\nf 1/0/1 2/0/1 4/0/1\nf 1/0/1 4/0/1 3/0/1\nf 2/0/1 3/0/1 4/0/1\n",
        "f -4/1/1 -2/1/1 -3/1/1\nf 1 2 4\nf 1/1 4/1 3/1\nf 2//1 3 4/7\n"}) {
    EXPECT_NEAR(propertiesOf(write("thing.obj", vertices + faces)).volume, 1.0 / 6, 1e-7) << faces;
  }
}

// OFF text of the unit cube. `more` follows the coordinates of each vertex.
std::string offText(const std::string& mark, const std::string& more = "") {
  std::string text = mark + "\n# a cube\n8 6 12\n\n";
  for (const char* const vertex :
       {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"}) {
    text += vertex + more + "\n";
  }
  return text +
         "4 3 2 1 0 0.1 0.2 0.3\n4 4 5 6 7 # top\n\n4\t0 1 5 4 7\n4 1 2 6 5\n4 2 3 7 6\n"
         "4 3 0 4 7";
}

TEST_F(MeshImport, OffFacesHaveAnyNumberOfCorners) {
  for (const std::string& text :
       {offText("OFF"), offText("COFF", " 1 0 0 1"), offText("4OFF", " 1")}) {
    EXPECT_NEAR(propertiesOf(write("cube.off", text)).volume, 1, 1e-6) << text;
  }
  const int count = 12;  // corners of a prism of radius 1 and height 1
  std::ostringstream prism;
  prism << 2 * count << " " << count + 2 << "\n";  // no mark
  for (int i = 0; i < 2 * count; ++i) {
    const double angle = 2 * kPi * i / count;
    prism << std::cos(angle) << " " << std::sin(angle) << " " << i / count << "\n";
  }
  prism << count;
  for (int i = 0; i < count; ++i) prism << " " << count - 1 - i;
  prism << "\n" << count;
  for (int i = 0; i < count; ++i) prism << " " << count + i;
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    prism << "\n4 " << i << " " << next << " " << count + next << " " << count + i;
  }
  // Twelve triangles with sides 1 and 1 at 30 degrees.
  EXPECT_NEAR(propertiesOf(write("prism.off", prism.str())).volume, count * 0.25, 1e-5);
}

TEST_F(MeshImport, OffFilesThatClaimTooMuchAreRefused) {
  const std::string cube = offText("OFF");
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = cube;
    text.replace(text.find(from), from.size(), to);
    const std::string message = refusal(write("damaged.off", text));
    EXPECT_EQ(message.substr(0, kUnreadable.size()), kUnreadable) << message;
    return message.substr(kUnreadable.size());
  };
  const std::size_t size = cube.size() + std::string("400000000").size();
  EXPECT_EQ(
      refused("8 6 12", "4000000000 6 12"),
      "the header announces 4000000000 vertices, at most " + std::to_string(size / 6) + " fit");
  EXPECT_EQ(refused("8 6 12", "8 -6 12").substr(0, 30), "the header announces -6 faces,");
  EXPECT_EQ(refused("8 6 12", "8 7 12"), "face 6 is missing");
  EXPECT_EQ(refused("8 6 12", "8"), "the header is cut short");
  EXPECT_EQ(refused("1 1 0\n", "1 1\n"), "vertex 2 is cut short");
  EXPECT_EQ(refused("4 1 2 6 5", "5 1 2 6 5"), "face 3 announces 5 corners, at most 4 fit");
  EXPECT_EQ(refused("4 1 2 6 5", "4 1 2 6 8"),
            "face 3 refers to vertex 8, but there are 8 vertices");
  EXPECT_EQ(refused("OFF", "OFF BINARY"), "the header is damaged: \"BINARY\" is not a number");
  EXPECT_EQ(refused("OFF", "nOFF"), "it is an OFF file of n dimensions");
}

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
