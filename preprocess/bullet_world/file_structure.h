#pragma once

#include <string>

namespace ambient {

/// Checks what Bullet's importer takes for granted in the bytes of a .bullet file: its header,
/// chunks that end inside the file and hold the structures that they announce, and a description
/// of those structures (DNA) that is whole. The content of the structures is not looked at.
/// @throws std::runtime_error in one line that begins with `name`.
void checkFileStructure(const std::string& bytes, const std::string& name);

}  // namespace ambient
