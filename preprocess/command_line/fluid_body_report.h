#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// A vector as a JSON array.
template <class Vector>
nlohmann::ordered_json vectorJson(const Vector& vector) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) array.push_back(vector[i]);
  return array;
}

/// A matrix as a JSON array of its rows.
template <class Matrix>
nlohmann::ordered_json matrixJson(const Matrix& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(vectorJson(matrix.row(i)));
  return rows;
}

/// The text of an object, one line per key and per row of a matrix. Numbers have as many digits, 17
/// at most, as it takes to read back the same bits.
std::string jsonText(const nlohmann::ordered_json& object);

/// Returns one JSON object about a fluid body; numbers have all digits that the same bits need.
/// `seconds`: duration of the build, if it was built just now.
std::string reportJson(const FluidBody& body, std::optional<double> seconds);

/// Returns a table of the same facts for people, headed by the file's name.
std::string reportTable(const FluidBody& body, const std::string& file);

}  // namespace ambient
