#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "bullet_ambient/saved_state.h"
#include "preprocess/base/fluid_body_writer.h"
#include "tests/fuzz/targets/seed_bodies.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

// write_fuzz_seeds DIR: writes the fuzzers' first inputs, a folder DIR/<fuzzer> for each. Texts are
// in this file; .ci/check_fuzz adds scenes of data/.
namespace ambient::test {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!(stream << bytes)) throw std::runtime_error(file.string() + ": cannot be written");
}

// Vertices and faces of a tetrahedron, as text and as bytes of uint16 and float.
std::string listText(const TriangleMesh& mesh) {
  const std::string ply = plyText(mesh), end = "end_header\n";
  return ply.substr(ply.find(end) + end.size());
}

std::string gltfBuffer(const TriangleMesh& mesh) {
  std::string bytes;
  for (const int v : mesh.triangles.reshaped()) bytes += bytesOf(static_cast<std::uint16_t>(v));
  for (const double x : mesh.vertices.reshaped()) bytes += bytesOf(static_cast<float>(x));
  return bytes;
}

// Text of a glTF file; `uri` of the buffer: empty inside a .glb file.
std::string gltfText(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)"
         R"("buffers":[{)" +
         (uri.empty() ? "" : "\"uri\":\"" + uri + "\",") +
         R"("byteLength":72}],"bufferViews":[{"buffer":0,"byteLength":24},)"
         R"({"buffer":0,"byteOffset":24,"byteLength":48}],"accessors":[)"
         R"({"bufferView":0,"componentType":5123,"count":12,"type":"SCALAR"},)"
         R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC3",)"
         R"("min":[0,0,0],"max":[1,1,1]}]})";
}

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | static_cast<unsigned char>(bytes[i + k]);
    for (int shift = 18; shift >= 0; shift -= 6) text += digits[bits >> shift & 63];
  }
  return text;
}

std::string glbBytes(const std::string& buffer) {
  std::string json = gltfText("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto number = [](std::size_t value) { return bytesOf(static_cast<std::uint32_t>(value)); };
  return "glTF" + number(2) + number(28 + json.size() + buffer.size()) + number(json.size()) +
         "JSON" + json + number(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

// Writes one mesh per format; the first byte is the format's number in fuzz_mesh.cpp.
void writeMeshes(const fs::path& folder) {
  const TriangleMesh mesh = unitTetrahedron();
  const std::string buffer = gltfBuffer(mesh);
  write(folder / "obj", '\0' + objText(mesh));
  write(folder / "stl", '\1' + asciiStlText(mesh));
  write(folder / "stl_binary", '\1' + binaryStlText(mesh));
  write(folder / "ply", '\2' + plyText(mesh));
  write(folder / "gltf", '\3' + gltfText("data:application/octet-stream;base64," + base64(buffer)));
  write(folder / "glb", '\4' + glbBytes(buffer));
  write(folder / "off", "\5OFF\n4 4 0\n" + listText(mesh));
}

void writeShapes(const fs::path& folder) {
  const char* const shapes[] = {R"({"type": "sphere", "radius": 1, "faces": 80})",
                                R"({"type": "box", "half_sizes": [1, 2, 3], "faces": 48})",
                                R"({"type": "box", "size": [1, 2, 3]})",
                                R"({"type": "ellipsoid", "semi_axes": [1, 2, 3], "faces": 80})",
                                R"({"type": "cylinder", "radius": 1, "height": 2, "faces": 100})",
                                R"({"type": "capsule", "radius": 1, "height": 2, "faces": 100})",
                                R"({"type": "cone", "radius": 1, "height": 2, "faces": 100})",
                                R"({"type": "sheet", "size": [1, 2], "faces": 50})",
                                R"({"type": "sheet", "semi_axes": [1, 2], "faces": 50})",
                                R"({"type": "sheet", "file": "a.obj", "scale": 2})",
                                R"({"type": "mesh", "file": "a.obj", "scale": 2})"};
  int number = 0;
  for (const char* shape : shapes) write(folder / std::to_string(number++), shape);
}

void writeAll(const fs::path& folder) {
  writeMeshes(folder / "fuzz_mesh");
  writeShapes(folder / "fuzz_shape");
  write(folder / "fuzz_fluid_body" / "body", encodeFluidBody(seedFluidBody(), "seed"));
  write(folder / "fuzz_world_state" / "state", encodeState(seedState()));
  write(folder / "fuzz_scene_file" / "override",
        "bodies.0.mass=2\n"
        R"({"duration": 1, "time_step": 0.01, "bodies": [{"shape": {"type": "sphere", )"
        R"("radius": 1}, "mass": 1}]})");
}

}  // namespace
}  // namespace ambient::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_fuzz_seeds DIR\n");
    return 2;
  }
  try {
    ambient::test::writeAll(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_fuzz_seeds: %s\n", error.what());
    return 1;
  }
  return 0;
}
