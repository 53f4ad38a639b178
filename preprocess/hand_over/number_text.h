#pragma once

#include <string>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// The shortest text that reads back as the same bits; with a point in every locale.
std::string numberText(double number);

/// A number rounded to `digits`, for people.
std::string roundedText(double number, int digits = 4);

/// A number with `digits` after the point, for people; never -0.
std::string fixedText(double number, int digits);

/// Numbers with a separator between them.
template <class Vector>
std::string rowText(const Vector& row, const char* separator = " ") {
  std::string text;
  for (Eigen::Index i = 0; i < row.size(); ++i)
    text += (i > 0 ? separator : "") + numberText(row[i]);
  return text;
}

/// The entries of a 6x6 matrix in the order of other programs: translation before rotation.
Matrix6 linearFirst(const Matrix6& rotation_first);

}  // namespace ambient
