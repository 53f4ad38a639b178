#pragma once

#include <vector>

#include "tests/preprocess/potential_flow/study/accuracy_case.h"

namespace ambient::study {

/// Every shape of the table, with a user's mesh.
std::vector<AccuracyCase> accuracyCases();

}  // namespace ambient::study
