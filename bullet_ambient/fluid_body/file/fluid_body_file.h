#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

// Reading and writing of .ambient files, docs/file_format.md: always in double precision, so that
// one file serves both precisions of Bullet. Contents of files are std::string or string_view.

/// Reads a .ambient file. Checks every array before use: for any bytes, the function returns a
/// fluid body that satisfies checkFluidBody(), or throws.
/// @throws std::runtime_error with one sentence that names the file, what is wrong and the limit.
FluidBody readFluidBody(const std::filesystem::path& file);

/// Writes a .ambient file completely or not at all, see OutputFile: writes a temporary file in the
/// same folder and renames it. A symbolic link is followed. The same fluid body gives the same
/// bytes.
/// @throws std::runtime_error as readFluidBody(), also if `body` fails checkFluidBody().
void writeFluidBody(const FluidBody& body, const std::filesystem::path& file);

/// Like readFluidBody(), but from memory; messages use `source` in place of the file name.
FluidBody decodeFluidBody(std::string_view bytes, const std::string& source);

/// Returns the bytes that writeFluidBody() writes; messages use `source` for the file name.
std::string encodeFluidBody(const FluidBody& body, const std::string& source);

/// Checks a fluid body: all numbers finite; centres and faces at most 1e12 body sizes from the
/// origin; unit normals; areas and volume >= 0; columns of equal length; added mass symmetric and
/// positive semi-definite up to rounding; triangles that index existing vertices.
/// @throws std::runtime_error with one sentence that begins with `source`.
void checkFluidBody(const FluidBody& body, const std::string& source);

}  // namespace ambient
