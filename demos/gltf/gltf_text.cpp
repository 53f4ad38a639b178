#include "demos/gltf/gltf_text.h"

#include <assimp/Exporter.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "demos/gltf/asset_scene.h"

namespace ambient {
namespace {

using json = nlohmann::ordered_json;

/// Output of the exporter: JSON, and the bytes of its only buffer.
struct Asset {
  json text;
  std::string buffer;
};

Asset exportAsset(const aiScene& scene) {
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, "gltf2");
  if (!blob || !blob->next)
    throw std::runtime_error(std::string("glTF: assimp cannot write it: ") +
                             exporter.GetErrorString());
  const auto bytes = [](const aiExportDataBlob& of) {
    return std::string(static_cast<const char*>(of.data), of.size);
  };
  return {json::parse(bytes(*blob)), bytes(*blob->next)};
}

/// Corrects the output of assimp 5.2: removes unused extensions, sets the buffer's length without
/// the container's padding, and writes the root's rotation as a quaternion.
void mend(Asset& asset, const Scene& scene) {
  asset.text.erase("extensionsUsed");
  asset.text["buffers"][0] = {{"byteLength", asset.buffer.size()}};
  const auto root = asset.text["scenes"][0]["nodes"][0].get<std::size_t>();
  const Quaternion turn = upToY(scene.gravity);
  json node = {{"name", scene.name}, {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}};
  if (asset.text["nodes"][root].contains("children"))
    node["children"] = asset.text["nodes"][root]["children"];
  asset.text["nodes"][root] = node;
}

/// Renames nodes, meshes and materials to the names of their bodies.
void nameBodies(json& text, const Scene& scene) {
  for (const char* kind : {"nodes", "meshes", "materials"})
    for (json& entry : text[kind]) {
      const std::string number = entry.value("name", "");
      for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (number == std::to_string(i)) {
          entry["name"] = scene.bodies[i].name;
          break;
        }
    }
}

std::string toBase64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

void appendNumber(std::string& bytes, std::uint32_t number) {
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(number >> (8 * k) & 255u);
}

/// Appends a chunk: length, kind, and bytes filled up to a multiple of four.
void appendChunk(std::string& container, const char (&kind)[5], std::string bytes, char filling) {
  bytes.append((4 - bytes.size() % 4) % 4, filling);
  appendNumber(container, static_cast<std::uint32_t>(bytes.size()));
  container.append(kind, 4);
  container += bytes;
}

std::string makeContainer(const Asset& asset) {
  std::string chunks;
  appendChunk(chunks, "JSON", asset.text.dump(), ' ');
  appendChunk(chunks, "BIN\0", asset.buffer, '\0');
  std::string container = "glTF";
  appendNumber(container, 2);
  appendNumber(container, static_cast<std::uint32_t>(12 + chunks.size()));
  return container + chunks;
}

}  // namespace

bool isGltfName(const std::filesystem::path& file) {
  return file.extension() == ".glb" || file.extension() == ".gltf";
}

std::string makeGltf(const std::filesystem::path& file, const Scene& scene,
                     const std::vector<PreparedBody>& bodies,
                     const std::vector<std::vector<MotionSample>>& motion) {
  Asset asset = exportAsset(*makeAssetScene(scene, bodies, motion));
  nameBodies(asset.text, scene);
  mend(asset, scene);
  if (file.extension() == ".glb") return makeContainer(asset);
  asset.text["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," + toBase64(asset.buffer);
  return asset.text.dump(1) + "\n";
}

}  // namespace ambient
