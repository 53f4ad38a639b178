// Reads a mesh file, mostly with assimp, and writes its triangles to standard output:
//   ambient_mesh_reader FILE SECONDS
// A program of its own, for damaged files make some readers crash or run for ever (assimp 5.2: PLY
// files with a torn header). It is started by readSceneTriangles(), which says what it writes.
#include <assimp/config.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
namespace {

/// Collects the polygons of a file, divided into triangles.
class PolygonCollector {
 public:
  /// Begins a list of vertices: the corners of polygons count from here on. They belong to the node
  /// with this name.
  void beginMesh(const std::string& name = {}) {
    first_ = vertexCount();
    names_.push_back(name);
  }
  void addVertex(const Eigen::Vector3d& vertex) {
    coordinates_.insert(coordinates_.end(), {vertex.x(), vertex.y(), vertex.z()});
  }
  /// Polygons of one or two corners are counted and left out.
  /// @throws std::runtime_error if it refers to a vertex that does not exist.
  void addPolygon(std::vector<int> polygon) {
    if (polygon.size() < 3) {
      ++points_and_lines_;
      return;
    }
    std::vector<Eigen::Vector3d> corners;
    const int count = vertexCount() - first_;
    for (int& index : polygon) {
      if (index < 0 || index >= count) {
        throw std::runtime_error("a face refers to vertex " + std::to_string(index) +
                                 ", but there are " + std::to_string(count) + " vertices");
      }
      index += first_;
      corners.emplace_back(
          Eigen::Map<const Eigen::Vector3d>(&coordinates_[3 * static_cast<std::size_t>(index)]));
    }
    for (const Eigen::Vector3i& t : dividePolygon(corners)) {
      indices_.insert(indices_.end(), {polygon[t[0]], polygon[t[1]], polygon[t[2]]});
      nodes_.push_back(static_cast<int>(names_.size()) - 1);
    }
  }

  const std::vector<double>& coordinates() const { return coordinates_; }
  const std::vector<int>& indices() const { return indices_; }
  /// Index of the name of each triangle's node; -1: none.
  const std::vector<int>& nodes() const { return nodes_; }
  const std::vector<std::string>& names() const { return names_; }
  std::int64_t pointsAndLines() const { return points_and_lines_; }

 private:
  int vertexCount() const { return static_cast<int>(coordinates_.size() / 3); }

  std::vector<double> coordinates_;
  std::vector<int> indices_, nodes_;
  std::vector<std::string> names_;
  int first_ = 0;
  std::int64_t points_and_lines_ = 0;
};

/// Polygons of a scene, placed by its nodes, once per node, and a warning line if the reader of the
/// format has turned the axes.
struct AssimpScene {
  PolygonCollector polygons;
  std::string warning;
};

// "f 1/2/3 4//5" becomes "f 1 4".
std::string withoutSlashes(const std::string& obj) {
  std::string text;
  bool leaves_out = false;
  for (const char c : obj) {
    const bool is_space = std::isspace(static_cast<unsigned char>(c)) != 0;
    leaves_out = !is_space && (leaves_out || c == '/');
    if (!leaves_out) text += c;
  }
  return text;
}

std::string withoutElements(std::string xml, const std::string& name) {
  const std::string begin = "<" + name, end = "</" + name + ">";
  std::size_t first = 0;
  while ((first = xml.find(begin, first)) != std::string::npos) {
    const std::size_t close = xml.find('>', first);
    if (close == std::string::npos) return xml;
    const std::size_t last = xml[close - 1] == '/' ? close + 1 - end.size() : xml.find(end, close);
    if (last == std::string::npos) return xml;
    xml.erase(first, last + end.size() - first);
  }
  return xml;
}

/// Reads a file. @throws std::runtime_error if it cannot be read.
std::string readText(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw std::runtime_error("cannot be read");
  return text;
}

std::string inSmallLetters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Extension of a file in small letters: "obj" for "Thing.OBJ".
std::string extensionOf(const std::string& file) {
  std::string extension = inSmallLetters(std::filesystem::path(file).extension().string());
  extension.erase(0, 1);
  return extension;
}

/// Returns the text of an OBJ or COLLADA file without parts that are not geometry and that make
/// assimp 5.2 refuse the file: texture coordinates and normals at the corners of faces, which it
/// miscounts if a file has normals only; effects, whose images may have no source. None for files
/// of other formats.
std::optional<std::string> geometryText(const std::string& file) {
  const std::string extension = extensionOf(file);
  if (extension == "obj") return withoutSlashes(readText(file));
  if (extension != "dae") return std::nullopt;
  return withoutElements(withoutElements(readText(file), "library_effects"), "library_images");
}

/// "0.5 x - y" of a row; what is rounding only is left out.
std::string sumText(const Eigen::RowVector3d& row) {
  constexpr double kRounding = 1e-6;  // of single precision
  std::ostringstream text;
  text.precision(6);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(row[k]) <= kRounding) continue;
    const bool is_first = text.tellp() == 0;
    if (row[k] < 0) text << (is_first ? "-" : " - ");
    if (row[k] > 0 && !is_first) text << " + ";
    if (std::abs(std::abs(row[k]) - 1) > kRounding) text << std::abs(row[k]) << " ";
    text << "xyz"[k];
  }
  return text.str();
}

/// Returns one line that says how assimp has turned the axes of a file; empty if it has not. The
/// readers of some old formats turn z into y by the root node of the scene, whose linear part is
/// `root`.
std::string turnedAxesWarning(const std::string& extension, const Eigen::Matrix3d& root) {
  static const std::set<std::string> turned{"3ds",    "ase", "ask",     "dxf", "ifc",
                                            "ifczip", "iqm", "md2",     "md3", "mdc",
                                            "mdl",    "prj", "md5mesh", "stp", "step"};
  if (turned.count(extension) == 0) return {};
  const double size = root.norm() / std::sqrt(3.0);
  const Eigen::Matrix3d rotation = size > 0 ? Eigen::Matrix3d(root / size) : root;
  if (rotation.isIdentity(1e-6)) return {};
  return "files of this format are turned when they are read: (x, y, z) becomes (" +
         sumText(rotation.row(0)) + ", " + sumText(rotation.row(1)) + ", " +
         sumText(rotation.row(2)) + ")";
}

Eigen::Affine3d transformOf(const aiNode& node) {
  const aiMatrix4x4& m = node.mTransformation;
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
      m.d1, m.d2, m.d3, m.d4;
  return transform;
}

void addMesh(const aiMesh& mesh, const Eigen::Affine3d& transform, const std::string& name,
             PolygonCollector& polygons) {
  polygons.beginMesh(name);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    polygons.addVertex(transform * Eigen::Vector3d(p.x, p.y, p.z));
  }
  const bool mirrors = transform.linear().determinant() < 0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    std::vector<int> polygon(face.mIndices, face.mIndices + face.mNumIndices);
    if (mirrors) std::reverse(polygon.begin(), polygon.end());
    polygons.addPolygon(polygon);
  }
}

void addNode(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& parent,
             PolygonCollector& polygons) {
  const Eigen::Affine3d transform = parent * transformOf(node);
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    addMesh(*scene.mMeshes[node.mMeshes[i]], transform, node.mName.C_Str(), polygons);
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    addNode(scene, *node.mChildren[i], transform, polygons);
}

// Without post-processing: aiProcess_Triangulate of assimp 5.2 cuts across concave corners.
const aiScene* readScene(Assimp::Importer& importer, const std::string& file) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const std::optional<std::string> text = geometryText(file);
  if (!text) return importer.ReadFile(file, 0);
  return importer.ReadFileFromMemory(text->data(), text->size(), 0, extensionOf(file).c_str());
}

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  text << "cannot be read as a mesh: ";
  (text << ... << parts);
  throw std::runtime_error(text.str());
}

/// Reads a file with assimp, the axes as they are in the file where that can be asked for.
/// @throws std::runtime_error with one sentence that does not name the file.
AssimpScene readWithAssimp(const std::string& file) {
  Assimp::Importer importer;
  const aiScene* scene = readScene(importer, file);
  if (scene == nullptr) {
    const std::string why = importer.GetErrorString();
    const bool wants_memory = why.find("bad_alloc") != std::string::npos;
    refuse(wants_memory ? "it announces more than there is memory for" : why);
  }
  AssimpScene result;
  if (scene->mRootNode == nullptr) return result;
  addNode(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), result.polygons);
  result.warning = turnedAxesWarning(extensionOf(file), transformOf(*scene->mRootNode).linear());
  return result;
}

/// The lines of a text that hold something, without comments, word by word.
class Rows {
 public:
  explicit Rows(const std::string& text) : stream_(text) {}

  /// Goes to the next row, that of `what`.
  void goTo(const std::string& what) {
    std::string line;
    for (words_.clear(); words_.empty(); words_ = wordsOf(line.substr(0, line.find('#'))))
      if (!std::getline(stream_, line)) refuse(what, " is missing");
    next_ = 0;
  }
  std::size_t wordsLeft() const { return words_.size() - next_; }
  /// @pre wordsLeft() > 0.
  const std::string& word() const { return words_[next_]; }
  void skipWord() { ++next_; }

  /// The number that the row goes on with; `what` should have one.
  double number(const std::string& what) {
    if (wordsLeft() == 0) refuse(what, " is cut short");
    const std::string& text = words_[next_++];
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (*end != '\0') refuse(what, " is damaged: \"", text, "\" is not a number");
    return value;
  }

  /// Reads how many things `what` announces, of which at most `most` fit.
  int count(const std::string& what, const char* things, std::size_t most) {
    const double value = number(what);
    if (!(value >= 0 && value <= static_cast<double>(most)))
      refuse(what, " announces ", value, " ", things, ", at most ", most, " fit");
    return static_cast<int>(value);
  }

 private:
  static std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream stream(line);
    return {std::istream_iterator<std::string>(stream), {}};
  }

  std::istringstream stream_;
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};

/// Content of the header.
struct OffHeader {
  bool is_homogeneous = false;  ///< vertices have a fourth coordinate, which divides the others
  int vertices = 0, faces = 0;
};

// Before the counts may stand a mark, which tells what vertices have: "OFF", "STCN4OFF".
OffHeader readHeader(Rows& rows, std::size_t file_size) {
  const std::string name = "the header";
  OffHeader header;
  rows.goTo(name);
  if (const std::string mark = rows.word(); mark.find("OFF") != std::string::npos) {
    if (mark.find('n') != std::string::npos) refuse("it is an OFF file of n dimensions");
    header.is_homogeneous = mark.find('4') != std::string::npos;
    rows.skipWord();
    if (rows.wordsLeft() == 0) rows.goTo(name);
  }
  constexpr std::size_t kShortestVertex = sizeof("0 0 0"), kShortestFace = sizeof("0");
  header.vertices = rows.count(name, "vertices", file_size / kShortestVertex);
  header.faces = rows.count(name, "faces", file_size / kShortestFace);
  return header;
}

// In single precision, as files of all formats are read.
Eigen::Vector3d readVertex(Rows& rows, int index, bool is_homogeneous) {
  const std::string name = "vertex " + std::to_string(index);
  rows.goTo(name);
  Eigen::Vector3d vertex;
  for (double& coordinate : vertex) coordinate = rows.number(name);
  if (is_homogeneous) vertex /= rows.number(name);
  return vertex.unaryExpr(&roundedToSingle);
}

std::vector<int> readFace(Rows& rows, int index, int vertices) {
  const std::string name = "face " + std::to_string(index);
  rows.goTo(name);
  std::vector<int> corners(rows.count(name, "corners", rows.wordsLeft() - 1));
  for (int& corner : corners) {
    const double vertex = rows.number(name);
    if (!(vertex >= 0 && vertex < vertices))
      refuse(name, " refers to vertex ", vertex, ", but there are ", vertices, " vertices");
    corner = static_cast<int>(vertex);
  }
  return corners;
}

/// Reads the text of an OFF file, of any number of corners per face; normals, colours and texture
/// coordinates are passed over. assimp 5.2 believes what the header announces, leaves out faces of
/// ten and more corners and moves indices that are too large.
/// @throws std::runtime_error with one sentence, if it is damaged, binary or not of three
/// dimensions.
PolygonCollector readOff(const std::string& text) {
  Rows rows(text);
  const OffHeader header = readHeader(rows, text.size());
  PolygonCollector polygons;
  for (int v = 0; v < header.vertices; ++v)
    polygons.addVertex(readVertex(rows, v, header.is_homogeneous));
  for (int f = 0; f < header.faces; ++f) polygons.addPolygon(readFace(rows, f, header.vertices));
  return polygons;
}

std::string trimmed(const std::string& line) {
  const char* const kSpace = " \t\r";
  const std::size_t first = line.find_first_not_of(kSpace);
  if (first == std::string::npos) return {};
  return line.substr(first, line.find_last_not_of(kSpace) + 1 - first);
}

bool beginsLikePly(std::istream& stream) {
  std::string magic(3, ' ');
  stream.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  return inSmallLetters(magic) == "ply";
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
  refuse("the header of the PLY file is damaged");
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
  write(triangles.nodes());
  std::fputs((warning + "\n").c_str(), stdout);
  for (std::string name : triangles.names()) {
    std::replace(name.begin(), name.end(), '\n', ' ');
    std::fputs((name + "\n").c_str(), stdout);
  }
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
