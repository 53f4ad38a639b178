#pragma once

#include <string>

#include "tests/preprocess/potential_flow/study/accuracy_case.h"

namespace ambient::study {

/// Markdown: one line per case whose name holds `filter`, printed as it is measured.
std::string accuracyTable(const std::string& filter);

}  // namespace ambient::study
