#include "tests/preprocess/table_generator/table_samples.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/added_mass_tables/table_places.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "tests/preprocess/table_generator/box_flow.h"
#include "tests/preprocess/table_generator/revolution_flow.h"

namespace ambient {
namespace {

constexpr int kBoxRings = 16;
constexpr int kRatios = 25;  // cylinders and capsules
constexpr int kConeRatios = 21, kConeRoundings = 9;

// First words of the file.
const std::string kComment = "# Added mass of simple shapes by ";

/// Node from -1 to 1, denser towards both ends.
double chebyshevNode(int i, int count) { return -portable::cos(kPi * i / (count - 1)); }

double ratioAt(double x) { return portable::pow(kLargestRatio, x); }

/// Appends rings around the cube in the plane of logarithms, denser towards the largest ratio.
void appendBoxes(std::vector<TableShape>& shapes) {
  for (int ring = 0; ring <= kBoxRings; ++ring) {
    const double longest = ratioAt(portable::sin(kPi / 2 * ring / kBoxRings));
    const int count = (ring + 1) / 2 + 1;
    for (int i = 0; i < count; ++i) {
      const double share = count == 1 ? 0 : (1 + chebyshevNode(i, count)) / 2;
      shapes.push_back({TableShape::kBox, {longest, portable::pow(longest, share), 1}});
    }
  }
}

void appendCones(std::vector<TableShape>& shapes) {
  for (int i = 0; i < kConeRatios; ++i) {
    const double height = 2 * ratioAt(chebyshevNode(i, kConeRatios));
    const double thickness = height / (1 + height);
    for (int j = 0; j < kConeRoundings; ++j) {
      const double root = (1 + chebyshevNode(j, kConeRoundings)) / 2;
      const double share = kLargestRounding * root * root;
      shapes.push_back({TableShape::kCone, {1, height, thickness * share / (1 - share)}});
    }
  }
}

}  // namespace

const char* nameOf(TableShape::Kind kind) {
  static const char* const kNames[] = {"box", "cylinder", "capsule", "cone"};
  return kNames[kind];
}

std::string TableShape::text() const {
  char text[100];
  std::snprintf(text, sizeof text, "%s %.9g %.9g %.9g", nameOf(kind), sizes[0], sizes[1], sizes[2]);
  return text;
}

std::vector<TableShape> tableShapes() {
  std::vector<TableShape> shapes;
  appendBoxes(shapes);
  for (int i = 0; i < kRatios; ++i) {
    const double x = chebyshevNode(i, kRatios);
    const double slenderness = portable::expm1((1 + x) / 2 * portable::log1p(kLargestRatio));
    shapes.push_back({TableShape::kCylinder, {1, 2 * ratioAt(x), 0}});
    // The first capsule is a ball, without rotational added mass.
    if (i > 0) shapes.push_back({TableShape::kCapsule, {1, 2 * slenderness, 0}});
  }
  appendCones(shapes);
  return shapes;
}

std::vector<double> solveShape(const TableShape& shape) {
  const Vector3& s = shape.sizes;
  if (shape.kind == TableShape::kBox) {
    const Vector6 K = solveBoxFlow(s);
    return {K.begin(), K.end()};
  }
  const RevolutionInertia K =
      solveRevolutionFlow(shape.kind == TableShape::kCylinder  ? cylinderMeridian(s[0], s[1])
                          : shape.kind == TableShape::kCapsule ? capsuleMeridian(s[0], s[1])
                                                               : coneMeridian(s[0], s[1], s[2]));
  return {K.v_z, K.v_x, K.w_y, K.coupling};
}

TableSamples::TableSamples(std::filesystem::path file) : file_(std::move(file)) {
  std::ifstream stream(file_);
  std::string line;
  while (std::getline(stream, line)) {
    if (line.rfind(kComment, 0) == 0) origin_ = line.substr(kComment.size());
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    std::istringstream numbers(line.substr(colon + 2));
    std::vector<double> entries;
    for (double number = 0; numbers >> number;) entries.push_back(number);
    known_[line.substr(0, colon)] = entries;
  }
}

const std::vector<double>* TableSamples::find(const TableShape& shape) const {
  const auto found = known_.find(shape.text());
  return found == known_.end() ? nullptr : &found->second;
}

void TableSamples::add(const TableShape& shape, const std::vector<double>& entries) {
  known_[shape.text()] = entries;
  std::ofstream stream(file_, std::ios::app);
  if (origin_.empty()) stream << kComment << (origin_ = libraryVersion()) << "\n";
  stream.precision(9);
  stream << shape.text() << ":";
  for (const double entry : entries) stream << " " << entry;
  stream << "\n";
  if (!stream.flush()) throw std::runtime_error(file_.string() + ": cannot be written");
}

}  // namespace ambient
