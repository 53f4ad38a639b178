#include "preprocess/mesh/import/scene_triangles.h"

#include <algorithm>
#include <csignal>
#include <stdexcept>

#include "preprocess/mesh/import/child_process.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
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

/// The next columns of three numbers in the reader's output.
template <class Number>
Eigen::Matrix<Number, 3, Eigen::Dynamic> take(const std::string& bytes, std::size_t& place,
                                              std::int64_t columns) {
  const std::size_t size = 3 * sizeof(Number) * static_cast<std::size_t>(columns);
  if (size > bytes.size() - place) throw std::runtime_error("its reader ended without a result");
  Eigen::Matrix<Number, 3, Eigen::Dynamic> numbers(3, columns);
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
  scene.warning = reader.output.substr(place);
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

}  // namespace ambient
