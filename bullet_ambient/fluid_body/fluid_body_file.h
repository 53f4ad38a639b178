#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

// The .ambient file of docs/file_format.md: always double precision, so that one file serves both
// precisions of Bullet. Bytes travel as std::string and std::string_view, like file contents do.

/// Reads a .ambient file. Every array is checked before it is used: whatever the bytes, the result
/// is a fluid body that satisfies checkFluidBody(), or an exception.
/// @throws std::runtime_error with one sentence that names the file, what is wrong and the limit.
FluidBody readFluidBody(const std::filesystem::path& file);

/// Writes a .ambient file under a temporary name beside `file` and renames it: the old file or the
/// new one, never half of it. A symbolic link stays, what it leads to is replaced. The same fluid
/// body gives the same bytes.
/// @throws std::runtime_error as readFluidBody(), also if `body` fails checkFluidBody().
void writeFluidBody(const FluidBody& body, const std::filesystem::path& file);

/// readFluidBody() from memory; `source` stands for the file name in messages.
FluidBody decodeFluidBody(std::string_view bytes, const std::string& source);

/// The bytes that writeFluidBody() writes; `source` stands for the file name in messages.
std::string encodeFluidBody(const FluidBody& body, const std::string& source);

/// What every fluid body must satisfy: finite everywhere, centres and faces within 1e12 of its
/// sizes from the origin, unit normals, areas >= 0, arrays of equal length, added mass symmetric
/// and positive semi-definite up to rounding, volume >= 0, triangles that index existing vertices.
/// @throws std::runtime_error with one sentence that begins with `source`.
void checkFluidBody(const FluidBody& body, const std::string& source);

}  // namespace ambient
