#pragma once

#include <optional>
#include <string>

namespace ambient {

/// Reads a file. @throws std::runtime_error if it cannot be read.
std::string readText(const std::string& file);

/// Extension of a file in small letters: "obj" for "Thing.OBJ".
std::string extensionOf(const std::string& file);

/// Returns the text of an OBJ or COLLADA file without parts that are not geometry and that make
/// assimp 5.2 refuse the file: texture coordinates and normals at the corners of faces, which it
/// miscounts if a file has normals only; effects, whose images may have no source. None for files
/// of other formats.
std::optional<std::string> geometryText(const std::string& file);

}  // namespace ambient
