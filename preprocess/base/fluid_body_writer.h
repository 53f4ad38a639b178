#pragma once

#include <filesystem>
#include <string>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"

namespace ambient {

/// Writes a .ambient file completely or not at all, see OutputFile: writes a temporary file in the
/// same folder and renames it. A symbolic link is followed. The same fluid body gives the same
/// bytes.
/// @throws std::runtime_error as readFluidBody(), also if `body` fails checkFluidBody().
void writeFluidBody(const FluidBody& body, const std::filesystem::path& file);

/// Returns the bytes that writeFluidBody() writes; messages use `source` for the file name.
std::string encodeFluidBody(const FluidBody& body, const std::string& source);

/// Returns the bytes of a header, which come before the payload.
std::string encodeFileHeader(const FileHeader& header);

}  // namespace ambient
