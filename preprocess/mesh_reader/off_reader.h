#pragma once

#include <string>

#include "preprocess/mesh_reader/polygon_collector.h"

namespace ambient {

/// Reads the text of an OFF file, of any number of corners per face; normals, colours and texture
/// coordinates are passed over. assimp 5.2 believes what the header announces, leaves out faces of
/// ten and more corners and moves indices that are too large.
/// @throws std::runtime_error with one sentence, if it is damaged, binary or not of three
/// dimensions.
PolygonCollector readOff(const std::string& text);

}  // namespace ambient
