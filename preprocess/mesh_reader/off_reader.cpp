#include "preprocess/mesh_reader/off_reader.h"

#include <cstdlib>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/single_precision.h"

namespace ambient {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  text << "cannot be read as a mesh: ";
  (text << ... << parts);
  throw std::runtime_error(text.str());
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

}  // namespace

PolygonCollector readOff(const std::string& text) {
  Rows rows(text);
  const OffHeader header = readHeader(rows, text.size());
  PolygonCollector polygons;
  for (int v = 0; v < header.vertices; ++v)
    polygons.addVertex(readVertex(rows, v, header.is_homogeneous));
  for (int f = 0; f < header.faces; ++f) polygons.addPolygon(readFace(rows, f, header.vertices));
  return polygons;
}

}  // namespace ambient
