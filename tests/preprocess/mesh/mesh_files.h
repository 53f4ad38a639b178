#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string>

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/support/temporary_folder.h"

namespace ambient {

inline std::string objText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << std::setprecision(17);
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    text << "v " << mesh.vertices(0, v) << ' ' << mesh.vertices(1, v) << ' ' << mesh.vertices(2, v)
         << '\n';
  }
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    text << "f " << mesh.triangles(0, t) + 1 << ' ' << mesh.triangles(1, t) + 1 << ' '
         << mesh.triangles(2, t) + 1 << '\n';
  }
  return text.str();
}

inline std::string asciiStlText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << std::setprecision(9) << "solid thing\n";
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) text << "vertex " << mesh.corner(t, k).transpose() << '\n';
    text << "endloop\nendfacet\n";
  }
  text << "endsolid thing\n";
  return text.str();
}

/// Little-endian bytes of a float32 or integer.
template <class Number>
std::string bytesOf(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

inline std::string binaryStlText(const TriangleMesh& mesh) {
  // A header with the word "solid", written by some exporters.
  std::string text = "solid but binary";
  text.resize(80, ' ');
  text += bytesOf(static_cast<std::uint32_t>(mesh.triangleCount()));
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    text += std::string(12, '\0');
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) text += bytesOf(static_cast<float>(mesh.corner(t, k)[c]));
    }
    text += std::string(2, '\0');
  }
  return text;
}

inline std::string plyText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << std::setprecision(17) << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertexCount()
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
       << mesh.triangleCount() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    text << mesh.vertices.col(v).transpose() << '\n';
  }
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    text << "3 " << mesh.triangles.col(t).transpose() << '\n';
  }
  return text.str();
}

/// Writes a glTF file and its buffer; `nodes` is the JSON of the nodes with mesh 0.
inline void writeGltf(const std::filesystem::path& file, const TriangleMesh& mesh,
                      const std::string& nodes) {
  std::string buffer;
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    for (int k = 0; k < 3; ++k) buffer += bytesOf(static_cast<float>(mesh.vertices(k, v)));
  }
  const std::size_t positions = buffer.size();
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) {
    buffer += bytesOf(static_cast<std::uint32_t>(mesh.triangles.data()[i]));
  }
  const std::string buffer_name = file.stem().string() + ".bin";
  writeText(file.parent_path() / buffer_name, buffer);
  const auto point = [](const Eigen::Vector3d& p) {
    std::ostringstream text;
    text << "[" << p.x() << "," << p.y() << "," << p.z() << "]";
    return text.str();
  };
  std::ostringstream text;
  text << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" << nodes
       << R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
       << R"("buffers":[{"uri":")" << buffer_name << R"(","byteLength":)" << buffer.size() << "}],"
       << R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" << positions
       << R"(},{"buffer":0,"byteOffset":)" << positions << R"(,"byteLength":)"
       << buffer.size() - positions << "}],"
       << R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)"
       << mesh.vertexCount() << R"(,"min":)" << point(mesh.vertices.rowwise().minCoeff())
       << R"(,"max":)" << point(mesh.vertices.rowwise().maxCoeff())
       << R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)"
       << mesh.triangles.size() << "}]}";
  writeText(file, text.str());
}

/// Writes small mesh files and reads them.
class MeshImport : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = folder_ / name;
    writeText(file, text);
    return file;
  }

  std::string refusal(const std::filesystem::path& file, double scale = 1) const {
    std::string message = messageOf([&] { importMesh(file, scale); });
    const std::string path = file.string();
    EXPECT_EQ(message.substr(0, path.size() + 2), path + ": ") << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message.substr(std::min(message.size(), path.size() + 2));
  }

  TemporaryFolder folder_;
};

inline MeshProperties propertiesOf(const std::filesystem::path& file, double scale = 1) {
  const std::string name = file.string();
  return computeMassProperties(
      requireSound(checkMesh(importMesh(file, scale).mesh, name), name).mesh);
}

}  // namespace ambient
