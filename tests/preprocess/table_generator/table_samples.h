#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// A shape of a table: its kind and its sizes [m].
struct TableShape {
  enum Kind { kBox, kCylinder, kCapsule, kCone };
  Kind kind;
  Vector3 sizes;  ///< half sizes; radius, height (of the cylindrical part), rounding

  /// Text of one line, the key in the file of samples.
  std::string text() const;
};

constexpr TableShape::Kind kTableKinds[] = {TableShape::kBox, TableShape::kCylinder,
                                            TableShape::kCapsule, TableShape::kCone};
const char* nameOf(TableShape::Kind kind);

/// The shapes that the tables are fitted to: Chebyshev nodes in the logarithms of the ratios.
std::vector<TableShape> tableShapes();

/// Entries of the added mass about the shape's origin. Box: the diagonal; others: v_z, v_x, w_y and
/// the coupling, see RevolutionInertia.
std::vector<double> solveShape(const TableShape& shape);

/// Solved shapes by TableShape::text(), in a text file. The file grows line by line, so that an
/// interrupted run can continue.
class TableSamples {
 public:
  explicit TableSamples(std::filesystem::path file);
  /// Returns null if the shape is not solved yet.
  const std::vector<double>* find(const TableShape& shape) const;
  void add(const TableShape& shape, const std::vector<double>& entries);
  /// Library, version and revision of the solver that started the file.
  const std::string& origin() const { return origin_; }

 private:
  std::filesystem::path file_;
  std::string origin_;
  std::map<std::string, std::vector<double>> known_;
};

}  // namespace ambient
