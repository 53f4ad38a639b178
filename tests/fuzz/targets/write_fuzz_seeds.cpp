#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "bullet_ambient/saved_state.h"
#include "preprocess/base/fluid_body_writer.h"
#include "tests/fuzz/targets/seed_bodies.h"

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

constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

template <class Number>
void append(std::string& bytes, const Number& number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string cornerText(int corner) {
  std::string text;
  for (const float x : kCorners[corner]) text += " " + std::to_string(static_cast<int>(x));
  return text;
}

std::string faceText(const int* face, int first) {
  return std::to_string(face[0] + first) + " " + std::to_string(face[1] + first) + " " +
         std::to_string(face[2] + first);
}

std::string objText() {
  std::string text;
  for (int v = 0; v < 4; ++v) text += "v" + cornerText(v) + "\n";
  for (const auto& face : kFaces) text += "f " + faceText(face, 1) + "\n";
  return text;
}

// Vertex and face lines, common to OFF and PLY files.
std::string listText() {
  std::string text;
  for (int v = 0; v < 4; ++v) text += cornerText(v).substr(1) + "\n";
  for (const auto& face : kFaces) text += "3 " + faceText(face, 0) + "\n";
  return text;
}

std::string plyText() {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n" +
         listText();
}

std::string stlText() {
  std::string text = "solid seed\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int v : face) text += "vertex" + cornerText(v) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid seed\n";
}

std::string stlBytes() {
  std::string bytes(80, ' ');
  append(bytes, std::uint32_t{4});
  for (const auto& face : kFaces) {
    bytes.append(3 * sizeof(float), '\0');
    for (const int v : face)
      for (const float x : kCorners[v]) append(bytes, x);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string gltfBuffer() {
  std::string bytes;
  for (const auto& face : kFaces)
    for (const int v : face) append(bytes, static_cast<std::uint16_t>(v));
  for (const auto& corner : kCorners)
    for (const float x : corner) append(bytes, x);
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

std::string glbBytes() {
  std::string json = gltfText(""), buffer = gltfBuffer();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(28 + json.size() + buffer.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

// Writes one mesh per format; the first byte is the format's number in fuzz_mesh.cpp.
void writeMeshes(const fs::path& folder) {
  write(folder / "obj", '\0' + objText());
  write(folder / "stl", '\1' + stlText());
  write(folder / "stl_binary", '\1' + stlBytes());
  write(folder / "ply", '\2' + plyText());
  write(folder / "gltf",
        '\3' + gltfText("data:application/octet-stream;base64," + base64(gltfBuffer())));
  write(folder / "glb", '\4' + glbBytes());
  write(folder / "off", "\5OFF\n4 4 0\n" + listText());
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
