#include "tests/preprocess/table_generator/table_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/spatial/large_products.h"
#include "preprocess/added_mass_tables/table_places.h"

namespace ambient {
namespace {

/// Terms T_i(x) T_j(y) of a series: those with i / rows + j / columns below `corner`.
struct SeriesTerms {
  int rows, columns;
  double corner = 2;

  bool has(int i, int j) const {
    return static_cast<double>(i) / rows + static_cast<double>(j) / columns < corner;
  }
};

/// A value to fit, at a place of the series.
struct SeriesPoint {
  TablePlace place;
  double value;
};

// Damping of the coefficients. Ratios of boxes leave corners of the square [-1, 1]^2 without
// samples, where an undamped series may grow.
constexpr double kDamping = 3e-5;

double chebyshev(int degree, double x) {
  return portable::cos(degree * portable::acos(std::clamp(x, -1.0, 1.0)));
}

FittedSeries fitSeries(const std::string& name, const SeriesTerms& terms,
                       const std::vector<SeriesPoint>& points) {
  std::vector<int> numbers;  // existing terms
  for (int k = 0; k < terms.rows * terms.columns; ++k)
    if (terms.has(k / terms.columns, k % terms.columns)) numbers.push_back(k);
  const auto size = static_cast<Eigen::Index>(points.size());
  const auto terms_size = static_cast<Eigen::Index>(numbers.size());
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(size + terms_size, terms_size);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(size + terms_size);
  for (Eigen::Index p = 0; p < size; ++p) {
    for (std::size_t t = 0; t < numbers.size(); ++t) {
      const int i = numbers[t] / terms.columns, j = numbers[t] % terms.columns;
      basis(p, t) = chebyshev(i, points[p].place.x) * chebyshev(j, points[p].place.y);
    }
    values[p] = points[p].value;
  }
  AMBIENT_ASSERT(size >= terms_size);
  fixBlocksOfLargeProducts();
  basis.bottomRows(terms_size).diagonal().setConstant(kDamping);
  const Eigen::VectorXd solution = basis.colPivHouseholderQr().solve(values);
  FittedSeries series{name, terms.rows, terms.columns, {}, 0};
  series.coefficients.assign(terms.rows * terms.columns, 0);
  for (std::size_t t = 0; t < numbers.size(); ++t) series.coefficients[numbers[t]] = solution[t];
  series.largest_residual = (basis * solution - values).head(size).cwiseAbs().maxCoeff();
  return series;
}

std::vector<FittedSeries> fitBoxes(const TableSamples& samples) {
  constexpr SeriesTerms kRotation{21, 11, 1}, kTranslation{17, 9, 1};
  std::vector<SeriesPoint> rotation, translation;
  for (const TableShape& shape : tableShapes()) {
    if (shape.kind != TableShape::kBox) continue;
    const std::vector<double>& K = *samples.find(shape);
    for (int k = 0; k < 3; ++k) {
      const BoxAxis axis{shape.sizes[k], shape.sizes[(k + 1) % 3], shape.sizes[(k + 2) % 3]};
      rotation.push_back({axis.place(), K[k] / axis.rotationScale()});
      translation.push_back({axis.place(), portable::log(K[3 + k] / axis.translationScale())});
    }
  }
  return {fitSeries("rotation", kRotation, rotation),
          fitSeries("translation", kTranslation, translation)};
}

RoundPlace placeOf(const TableShape& shape) {
  const Vector3& s = shape.sizes;
  if (shape.kind == TableShape::kCylinder) return cylinderPlace(s[0], s[1]);
  if (shape.kind == TableShape::kCapsule) return capsulePlace(s[0], s[1]);
  return conePlace(s[0], s[1], s[2]);
}

std::vector<FittedSeries> fitRound(TableShape::Kind kind, const TableSamples& samples) {
  const bool is_cone = kind == TableShape::kCone;
  const SeriesTerms terms = is_cone ? SeriesTerms{19, 9, 1.4} : SeriesTerms{21, 1, 2};
  std::vector<SeriesPoint> v_z, v_x, w_y, coupling;
  for (const TableShape& shape : tableShapes()) {
    if (shape.kind != kind) continue;
    const std::vector<double>& K = *samples.find(shape);
    const RoundPlace round = placeOf(shape);
    v_z.push_back({round.place, portable::log(K[0] / round.scale.v_z)});
    v_x.push_back({round.place, portable::log(K[1] / round.scale.v_x)});
    w_y.push_back({round.place, K[2] / round.scale.w_y});
    coupling.push_back({round.place, K[3] / round.scale.coupling});
  }
  std::vector<FittedSeries> series = {fitSeries("v_z", terms, v_z), fitSeries("v_x", terms, v_x),
                                      fitSeries("w_y", terms, w_y)};
  if (is_cone) series.push_back(fitSeries("coupling", terms, coupling));
  return series;
}

void appendSeries(const std::string& table, const FittedSeries& series, std::string& source) {
  constexpr int kPerLine = 8;
  source += "constexpr double " + table + "_" + series.name + "[] = {";
  char number[32];
  for (std::size_t k = 0; k < series.coefficients.size(); ++k) {
    std::snprintf(number, sizeof number, "%.7f,", series.coefficients[k]);
    source += (k % kPerLine == 0 ? "\n    " : " ") + std::string(number);
  }
  source += "};\n";
}

void appendTable(TableShape::Kind kind, const TableSamples& samples, std::string& source) {
  const std::string name = nameOf(kind);
  std::string list;
  source += "\nnamespace {\n\n";
  for (const FittedSeries& series : fitTable(kind, samples)) {
    appendSeries(name, series, source);
    list += (list.empty() ? "{" : ", {") + std::to_string(series.rows) + ", " +
            std::to_string(series.columns) + ", " + name + "_" + series.name + "}";
  }
  if (kind == TableShape::kCylinder || kind == TableShape::kCapsule) list += ", {}";
  const std::string type = kind == TableShape::kBox ? "BoxTable" : "RoundTable";
  source += "\n}  // namespace\n\nconst " + type + "& " + name + "Table() {\n  static constexpr " +
            type + " kTable = {" + list + "};\n  return kTable;\n}\n";
}

}  // namespace

std::vector<FittedSeries> fitTable(TableShape::Kind kind, const TableSamples& samples) {
  return kind == TableShape::kBox ? fitBoxes(samples) : fitRound(kind, samples);
}

std::string tableSource(const TableSamples& samples) {
  std::string source =
      "// Generated by added_mass_tables make, from samples by " + samples.origin() +
      ".\n\n"
      "#include \"preprocess/added_mass_tables/table_data.h\"\n\n// clang-format off\n"
      "namespace ambient {\n";
  for (const auto kind : kTableKinds) appendTable(kind, samples, source);
  return source + "\n}  // namespace ambient\n";
}

}  // namespace ambient
