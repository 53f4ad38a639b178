// Features of single file formats, and the meshes read from them.
#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "tests/preprocess/mesh/mesh_import_fixture.h"

namespace ambient {
namespace {

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

}  // namespace
}  // namespace ambient
