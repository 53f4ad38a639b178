#pragma once

#include <string>

#include "tests/preprocess/potential_flow/study/accuracy_case.h"

namespace ambient::study {

/// Markdown: a line per case with `filter` in its name, printed immediately.
std::string accuracyTable(const std::string& filter);

}  // namespace ambient::study
