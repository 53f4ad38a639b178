#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

/// The text of facts that a command has found: `json` or rows for people, which leave out what is
/// empty. Numbers in JSON have as many digits, 17 at most, as it takes to read back the same bits,
/// those for people 9, and what is rounding beside other numbers or the size of the body is 0.
std::string factsText(const nlohmann::ordered_json& facts, bool json);

/// Lists holds: name, volume, rims.
nlohmann::ordered_json holdsJson(const std::vector<Hold>& holds);

/// Returns the facts about a fluid body.
nlohmann::ordered_json bodyFacts(const FluidBody& body);

}  // namespace ambient
