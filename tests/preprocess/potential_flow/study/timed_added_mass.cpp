#include "tests/preprocess/potential_flow/study/timed_added_mass.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace ambient::study {
namespace {

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

}  // namespace

// The script prints processor seconds, wall seconds and the 36 entries.
TimedAddedMass runPointSources(const std::string& script, bool exact_flux, int takes,
                               const TriangleMesh& mesh) {
  const std::string command =
      "/usr/bin/python3 -B '" + script + "'" + (exact_flux ? " --exact-flux" : "");
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "potential_flow_study_race.obj";
  writeObj(mesh, file);
  std::istringstream output(
      outputOf(command + " --takes " + std::to_string(takes) + " '" + file.string() + "'"));
  std::filesystem::remove(file);
  TimedAddedMass row;
  output >> row.processor_seconds >> row.wall_seconds;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) output >> row.added_mass(i, j);
  if (!output) throw std::runtime_error(command + ": printed too few numbers");
  return row;
}

}  // namespace ambient::study
