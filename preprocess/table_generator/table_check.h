#pragma once

#include <string>

#include "preprocess/table_generator/table_samples.h"

namespace ambient {

/// Errors of a table over random shapes, against what it is made from, and how far a build by the
/// solver with its default settings is from it, one line each and the largest; in Markdown.
/// Relative to the largest entry of the block. Deterministic.
std::string checkTable(TableShape::Kind kind, int shapes, int seed);

}  // namespace ambient
