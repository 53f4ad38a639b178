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

  /// One line, also the key in the file of samples.
  std::string text() const;
};

constexpr TableShape::Kind kTableKinds[] = {TableShape::kBox, TableShape::kCylinder,
                                            TableShape::kCapsule, TableShape::kCone};
const char* nameOf(TableShape::Kind kind);

/// The shapes that the tables are fitted to: Chebyshev nodes in the logarithms of the ratios.
std::vector<TableShape> tableShapes();

/// Entries of the added mass about the shape's origin: of a box the diagonal, of others v_z, v_x,
/// w_y and the coupling as RevolutionInertia.
std::vector<double> solveShape(const TableShape& shape);

/// What was solved, by TableShape::text(); a text file that grows line by line, so that a run that
/// was stopped goes on where it was.
class TableSamples {
 public:
  explicit TableSamples(std::filesystem::path file);
  /// Null: not yet.
  const std::vector<double>* find(const TableShape& shape) const;
  void add(const TableShape& shape, const std::vector<double>& entries);
  /// Library, version and revision of the solver that the file was begun with.
  const std::string& origin() const { return origin_; }

 private:
  std::filesystem::path file_;
  std::string origin_;
  std::map<std::string, std::vector<double>> known_;
};

}  // namespace ambient
