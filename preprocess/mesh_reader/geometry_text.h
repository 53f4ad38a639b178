#pragma once

#include <optional>
#include <string>

namespace ambient {

/// Everything in a file. @throws std::runtime_error if it cannot be read.
std::string readText(const std::string& file);

/// "obj" of "Thing.OBJ".
std::string extensionOf(const std::string& file);

/// The text of an OBJ or COLLADA file without what has nothing to do with its geometry but makes
/// assimp 5.2 refuse it: texture coordinates and normals at the corners of faces, of which it loses
/// count where a file has normals only, and effects, whose images may have no source. Nothing for
/// files of other formats.
std::optional<std::string> geometryText(const std::string& file);

}  // namespace ambient
