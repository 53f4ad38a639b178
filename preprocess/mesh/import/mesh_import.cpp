#include "preprocess/mesh/import/mesh_import.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

namespace {

/// One end of a pipe.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  int number() const { return number_; }

 private:
  int number_;
};

std::string readAll(int descriptor) {
  std::string bytes;
  std::array<char, 65536> part{};
  for (;;) {
    const ssize_t count = ::read(descriptor, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(count));
  }
}

/// The program in `bin` beside the module that has this code, if it is one; beside the running
/// program; else the name, which the PATH is searched for.
std::string findProgram(const std::string& name) {
  static const char here = 0;
  Dl_info found;
  void* file = nullptr;
  std::vector<std::filesystem::path> folders;
  // The main program has no name here.
  if (::dladdr1(&here, &found, &file, RTLD_DL_LINKMAP) != 0)
    if (const std::string module = static_cast<link_map*>(file)->l_name; !module.empty())
      folders.push_back(std::filesystem::path(module).parent_path() / "bin");
  std::error_code error;
  folders.push_back(std::filesystem::read_symlink("/proc/self/exe", error).parent_path());
  for (const std::filesystem::path& folder : folders)
    if (std::filesystem::exists(folder / name, error)) return (folder / name).string();
  return name;
}

/// Starts a program that writes to `output`; returns the error, 0 if it runs.
int start(std::vector<std::string> command, int output, pid_t& child) {
  const std::string program = findProgram(command.front());
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  const int error =
      ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

ChildResult runChild(const std::vector<std::string>& command) {
  const std::string could_not = "the program " + command.front() + " could not be started: ";
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::runtime_error(could_not + std::strerror(errno));
  const Descriptor from_child(ends[0]);
  Descriptor to_parent(ends[1]);
  pid_t child = 0;
  const int error = start(command, to_parent.number(), child);
  if (error == ENOENT)
    throw std::runtime_error(could_not + "it is neither beside this program nor on the PATH");
  if (error != 0) throw std::runtime_error(could_not + std::strerror(error));
  to_parent.close();
  ChildResult result;
  result.output = readAll(from_child.number());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

namespace {

std::string oneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

int mostSecondsFor(const std::filesystem::path& file) {
  constexpr double kLeast = 10, kPerByte = 2e-6, kMost = 1e6;
  std::error_code error;
  const auto bytes = static_cast<double>(std::filesystem::file_size(file, error));
  return static_cast<int>(std::min(kMost, kLeast + (error ? 0 : kPerByte * bytes)));
}

void requireGoodEnd(const ChildResult& reader, int most_seconds) {
  const std::string its_reader = "cannot be read as a mesh: its reader ";
  if (reader.exit_code == kRefusedByReader) throw std::runtime_error(reader.output);
  if (reader.signal == SIGXCPU)
    throw std::runtime_error(its_reader + "took more than " + std::to_string(most_seconds) +
                             " s of processor time");
  if (reader.signal == SIGKILL)
    throw std::runtime_error(its_reader + "was killed, perhaps for want of memory");
  if (reader.signal != 0 || reader.exit_code != 0) throw std::runtime_error(its_reader + "crashed");
}

/// The next columns of numbers in the reader's output.
template <class Number, int kRows = 3>
Eigen::Matrix<Number, kRows, Eigen::Dynamic> take(const std::string& bytes, std::size_t& place,
                                                  std::int64_t columns) {
  const std::size_t size = kRows * sizeof(Number) * static_cast<std::size_t>(columns);
  if (size > bytes.size() - place) throw std::runtime_error("its reader ended without a result");
  Eigen::Matrix<Number, kRows, Eigen::Dynamic> numbers(kRows, columns);
  std::copy_n(bytes.data() + place, size, reinterpret_cast<char*>(numbers.data()));
  place += size;
  return numbers;
}

SceneTriangles readWithProgram(const std::filesystem::path& file) {
  const int most_seconds = mostSecondsFor(file);
  const ChildResult reader =
      runChild({"ambient_mesh_reader", file.string(), std::to_string(most_seconds)});
  requireGoodEnd(reader, most_seconds);
  std::size_t place = 0;
  const auto counts = take<std::int64_t>(reader.output, place, 1);
  SceneTriangles scene;
  scene.points_and_lines = counts(0);
  scene.mesh.vertices = take<double>(reader.output, place, counts(1));
  scene.mesh.triangles = take<int>(reader.output, place, counts(2));
  const auto nodes = take<int, 1>(reader.output, place, counts(2));
  scene.nodes.assign(nodes.data(), nodes.data() + nodes.size());
  std::istringstream text(reader.output.substr(place));
  std::getline(text, scene.warning);
  for (std::string name; std::getline(text, name);) scene.names.push_back(name);
  for (const int node : scene.nodes)
    if (node < -1 || node >= static_cast<int>(scene.names.size()))
      throw std::runtime_error("its reader ended without a result");
  return scene;
}

}  // namespace

SceneTriangles readSceneTriangles(const std::filesystem::path& file) {
  try {
    return readWithProgram(file);
  } catch (const std::exception& error) {
    raiseInputError(file.string(), oneLine(error.what()));
  }
}

namespace {

// Single precision relative to the origin, as the file gives it, may be coarse relative to the
// body. Refuses what would be a staircase.
std::string resolutionWarning(const TriangleMesh& mesh, double diagonal, const std::string& name) {
  constexpr double kCoarse = 1e-4, kTooCoarse = 0.01;
  const double farthest = mesh.vertices.cwiseAbs().maxCoeff();
  const double resolution = std::numeric_limits<float>::epsilon() * farthest / diagonal;
  if (resolution < kCoarse) return {};
  std::ostringstream warning;
  warning.precision(3);
  warning << "lies " << farthest / diagonal << " times its size from the origin, where single "
          << "precision resolves only " << resolution << " of its size: move it to the origin";
  if (resolution > kTooCoarse) raiseInputError(name, warning.str());
  return name + ": " + warning.str();
}

void weld(ImportedMesh& imported, const std::string& name) {
  TriangleMesh& mesh = imported.mesh;
  const double diagonal = mesh.extents().norm();
  const std::string warning = resolutionWarning(mesh, diagonal, name);
  if (!warning.empty()) imported.warnings.push_back(warning);
  const Eigen::Index before = mesh.triangleCount();
  mesh = weldVertices(mesh, kWeldTolerance * diagonal);
  if (mesh.triangleCount() == before) return;
  std::ostringstream text;
  text << name << ": " << before - mesh.triangleCount() << " of " << before
       << " triangles are shorter than " << kWeldTolerance << " of its size and were left out";
  imported.warnings.push_back(text.str());
}

// Reads a file that has triangles.
SceneTriangles readTriangles(const std::filesystem::path& file) {
  const std::string name = file.string();
  requireRegularFile(file, "mesh");
  if (std::filesystem::file_size(file) == 0) raiseInputError(name, "the file is empty");
  SceneTriangles scene = readSceneTriangles(file);
  if (scene.mesh.triangleCount() == 0) raiseInputError(name, "there are no triangles");
  return scene;
}

}  // namespace

ImportedMesh importMesh(const std::filesystem::path& file, double scale) {
  const std::string name = file.string();
  if (!std::isfinite(scale) || scale <= 0) {
    raiseInputError(name, "scale = ", scale, " is not positive and finite");
  }
  SceneTriangles scene = readTriangles(file);
  ImportedMesh imported{std::move(scene.mesh), {}};
  if (!scene.warning.empty()) imported.warnings.push_back(name + ": " + scene.warning);
  if (scene.points_and_lines > 0) {
    imported.warnings.push_back(name + ": " + std::to_string(scene.points_and_lines) +
                                " points and lines were left out");
  }
  // Vertices that are not finite cannot be welded; checkMesh() names them later.
  if (imported.mesh.vertices.allFinite()) weld(imported, name);
  imported.mesh.vertices *= scale;
  if (imported.mesh.triangleCount() == 0)
    raiseInputError(name, "all triangles are points or lines");
  return imported;
}

std::vector<TriangleMesh> importObjects(const std::filesystem::path& file) {
  const SceneTriangles scene = readTriangles(file);
  const std::string ending = file.extension().string();
  const bool has_objects = ending == ".obj" || ending == ".OBJ";
  std::map<std::string, std::size_t> places;  // a name has several nodes if its materials change
  std::vector<std::vector<Eigen::Vector3i>> triangles;
  for (Eigen::Index t = 0; t < scene.mesh.triangleCount(); ++t) {
    const int node = has_objects ? scene.nodes[static_cast<std::size_t>(t)] : -1;
    const std::string name = node < 0 ? "" : scene.names[static_cast<std::size_t>(node)];
    const auto [place, is_new] = places.try_emplace(name, triangles.size());
    if (is_new) triangles.emplace_back();
    triangles[place->second].push_back(scene.mesh.triangles.col(t));
  }
  std::vector<TriangleMesh> objects;
  for (const auto& of_object : triangles)
    objects.push_back(withUsedVertices(scene.mesh.vertices, of_object));
  return objects;
}

}  // namespace ambient
