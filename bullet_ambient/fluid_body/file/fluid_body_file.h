#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

// Header before the payload of a .ambient file: offsets and types, 32 bytes, little-endian.
//   0  magic            8 bytes
//   8  version          uint32
//   12 reserved         uint32, 0
//   16 payload size     uint64 [bytes]
//   24 payload checksum uint64, FNV-1a

/// Like PNG: a non-ASCII byte, the name, and line ends that a transfer in text mode damages.
inline constexpr std::string_view kFileMagic(
    "\x89"
    "AMB\r\n\x1a\n",
    8);
constexpr std::size_t kFileHeaderSize = 32;
constexpr std::uint32_t kFormatVersion = 4;  ///< newest version that can be read
/// Largest payload [bytes]: FlatBuffers addresses less than 2 GiB.
constexpr std::uint64_t kPayloadLimit = (std::uint64_t{1} << 31) - 1 - (std::uint64_t{1} << 16);

struct FileHeader {
  std::uint32_t version = 0;
  std::uint64_t payload_size = 0;
  std::uint64_t payload_checksum = 0;
};

/// Decodes the header at the start of `bytes`; `source` names the file in messages.
/// @throws std::runtime_error if it is empty, foreign, cut short, damaged or of a newer version.
FileHeader decodeFileHeader(std::string_view bytes, const std::string& source);

/// Throws std::runtime_error if the payload has not the size [bytes] that the header states.
void checkPayloadSize(const FileHeader& header, std::uint64_t present, const std::string& source);

// Reading of .ambient files, docs/file_format.md: always in double precision, so that
// one file serves both precisions of Bullet. Contents of files are std::string or string_view.

/// Reads a .ambient file. Checks every array before use: for any bytes, the function returns a
/// fluid body that satisfies checkFluidBody(), or throws.
/// @throws std::runtime_error with one sentence that names the file, what is wrong and the limit.
FluidBody readFluidBody(const std::filesystem::path& file);

/// Like readFluidBody(), but from memory; messages use `source` in place of the file name.
FluidBody decodeFluidBody(std::string_view bytes, const std::string& source);

/// Checks a fluid body: all numbers finite; centres and faces at most 1e12 body sizes from the
/// origin; unit normals; areas and volume >= 0; columns of equal length; added mass symmetric and
/// positive semi-definite up to rounding; triangles that index existing vertices; holds that are
/// closed and leave something for the walls.
/// @throws std::runtime_error with one sentence that begins with `source`.
void checkFluidBody(const FluidBody& body, const std::string& source);

/// Reads a .ambient file like readFluidBody(); the result is shared by all bodies of the shape.
/// @throws std::runtime_error as readFluidBody().
std::shared_ptr<const FluidBody> loadFluidBody(const std::string& file);

}  // namespace ambient
