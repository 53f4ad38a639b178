// Reads a mesh file, mostly with assimp, and writes its triangles to standard output:
//   ambient_mesh_reader FILE SECONDS
// A program of its own, for damaged files make some readers crash or run for ever (assimp 5.2: PLY
// files with a torn header). It is started by readSceneTriangles(), which says what it writes.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "preprocess/mesh/import/scene_triangles.h"
#include "preprocess/mesh_reader/readers.h"

namespace ambient {
namespace {

std::string trimmed(const std::string& line) {
  const char* const kSpace = " \t\r";
  const std::size_t first = line.find_first_not_of(kSpace);
  if (first == std::string::npos) return {};
  return line.substr(first, line.find_last_not_of(kSpace) + 1 - first);
}

bool beginsLikePly(std::istream& stream) {
  std::array<char, 3> magic{};
  stream.read(magic.data(), magic.size());
  std::transform(magic.begin(), magic.end(), magic.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return magic == std::array<char, 3>{'p', 'l', 'y'};
}

// In a torn header assimp 5.2 looks for the next line that it knows for ever.
void requirePlyHeader(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!beginsLikePly(stream)) return;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    const std::string text = trimmed(line);
    if (text == "end_header") return;
    const std::string word = text.substr(0, text.find_first_of(" \t"));
    const auto known = {"", "comment", "element", "format", "obj_info", "property"};
    if (std::find(known.begin(), known.end(), word) == known.end()) break;
  }
  throw std::runtime_error("cannot be read as a mesh: the header of the PLY file is damaged");
}

template <class Number>
void write(const std::vector<Number>& numbers) {
  std::fwrite(numbers.data(), sizeof(Number), numbers.size(), stdout);
}

void writeTriangles(const PolygonCollector& triangles, const std::string& warning) {
  write<std::int64_t>({triangles.pointsAndLines(),
                       static_cast<std::int64_t>(triangles.coordinates().size() / 3),
                       static_cast<std::int64_t>(triangles.indices().size() / 3)});
  write(triangles.coordinates());
  write(triangles.indices());
  std::fputs(warning.c_str(), stdout);
}

// A crash shall end the program by its signal, without anybody's handler, report or core file.
void limitProcess(const char* most_seconds) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU})
    ::signal(signal, SIG_DFL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const auto seconds = static_cast<rlim_t>(std::strtoul(most_seconds, nullptr, 10));
  const rlimit processor_time{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &processor_time);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the system's own interface
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
}

int readFile(const std::string& file) {
  try {
    if (extensionOf(file) == "off") {
      writeTriangles(readOff(readText(file)), {});
    } else {
      requirePlyHeader(file);
      const AssimpScene scene = readWithAssimp(file);
      writeTriangles(scene.polygons, scene.warning);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fputs(error.what(), stdout);
    return kRefusedByReader;
  }
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: ambient_mesh_reader FILE SECONDS\n", stderr);
    return 2;
  }
  ambient::limitProcess(argv[2]);
  const int result = ambient::readFile(argv[1]);
  // Without the exit handlers of libraries whose memory may be damaged.
  std::_Exit(std::fflush(stdout) == 0 ? result : 1);
}
