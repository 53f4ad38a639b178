#include "preprocess/mesh_reader/turned_axes.h"

#include <cmath>
#include <set>
#include <sstream>

namespace ambient {
namespace {

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

}  // namespace

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

}  // namespace ambient
