#include "tests/study/point_source_race.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/study/accuracy_case.h"

namespace ambient::study {
namespace {

struct RaceRow {
  Matrix6 added_mass = Matrix6::Zero();
  double processor_seconds = std::numeric_limits<double>::infinity();
  double wall_seconds = std::numeric_limits<double>::infinity();
};

constexpr int kTakes = 3;

RaceRow raceBuild(const TriangleMesh& mesh, int threads) {
  RaceRow best;
  for (int take = 0; take < kTakes; ++take) {
    const double begin = processorSeconds();
    const auto start = std::chrono::steady_clock::now();
    best.added_mass = builtAddedMass(mesh, false, kDefaultPanels, threads);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    best.processor_seconds = std::min(best.processor_seconds, processorSeconds() - begin);
    best.wall_seconds = std::min(best.wall_seconds, wall.count());
  }
  return best;
}

void writeObj(const TriangleMesh& mesh, const std::filesystem::path& file) {
  std::ofstream stream(file);
  stream.precision(17);
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v)
    stream << "v " << mesh.vertices.col(v).transpose() << "\n";
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    stream << "f " << (mesh.triangles.col(t).array() + 1).transpose() << "\n";
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

std::string outputOf(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error(command + ": cannot be started");
  std::string output;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
  if (pclose(pipe) != 0) throw std::runtime_error(command + ": failed");
  return output;
}

/// The script prints processor seconds, wall seconds and the 36 entries.
RaceRow racePointSources(const std::string& command, const TriangleMesh& mesh) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "potential_flow_study_race.obj";
  writeObj(mesh, file);
  std::istringstream output(outputOf("/usr/bin/python3 -B " + command + " --takes " +
                                     std::to_string(kTakes) + " '" + file.string() + "'"));
  std::filesystem::remove(file);
  RaceRow row;
  output >> row.processor_seconds >> row.wall_seconds;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) output >> row.added_mass(i, j);
  if (!output) throw std::runtime_error(command + ": printed too few numbers");
  return row;
}

}  // namespace

std::string pointSourceRace(const std::string& script) {
  std::string table =
      "| body | method | vertices | rotation | translation | processor | wall |\n"
      "|---|---|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  for (const double height : {1.0, 0.5, 0.1}) {
    const Vector3 semi_axes(1, 1, height);
    ShapeDescription shape;
    shape.geometry = EllipsoidShape{semi_axes};
    shape.faces = 2900;
    const TriangleMesh mesh = makeShapeMesh(shape).mesh;
    const Reference exact{reference::ellipsoidAddedMass(semi_axes).asDiagonal(), 0};
    const auto add = [&](const char* method, const RaceRow& row) {
      const AccuracyRow error = compareAddedMass(row.added_mass, exact, Symmetry::kThreeMirrors);
      char line[256];
      std::snprintf(line, sizeof line,
                    "| spheroid 1 : 1 : %g | %s | %ld | %.1e | %.1e | %.2f s | %.2f s |\n", height,
                    method, static_cast<long>(mesh.vertexCount()), error.rotation,
                    error.translation, row.processor_seconds, row.wall_seconds);
      std::fputs(line, stdout);
      std::fflush(stdout);
      table += line;
    };
    add("complete build, 2 threads", raceBuild(mesh, 2));
    const std::string quoted = "'" + script + "'";
    add("point sources, velocity at vertices", racePointSources(quoted, mesh));
    add("point sources, exact flux", racePointSources(quoted + " --exact-flux", mesh));
  }
  return table;
}

}  // namespace ambient::study
