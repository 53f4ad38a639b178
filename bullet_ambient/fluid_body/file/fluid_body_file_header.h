#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace ambient {

// Header before the payload of a .ambient file: offsets and types, 32 bytes, little-endian.
//   0  magic            8 bytes
//   8  version          uint32
//   12 reserved         uint32, 0
//   16 payload size     uint64 [bytes]
//   24 payload checksum uint64, FNV-1a

constexpr std::size_t kFileHeaderSize = 32;
constexpr std::uint32_t kFormatVersion = 3;  ///< newest version that can be read
/// Largest payload [bytes]: FlatBuffers addresses less than 2 GiB.
constexpr std::uint64_t kPayloadLimit = (std::uint64_t{1} << 31) - 1 - (std::uint64_t{1} << 16);

struct FileHeader {
  std::uint32_t version = 0;
  std::uint64_t payload_size = 0;
  std::uint64_t payload_checksum = 0;
};

std::string encodeFileHeader(const FileHeader& header);

/// Decodes the header at the start of `bytes`; `source` names the file in messages.
/// @throws std::runtime_error if it is empty, foreign, cut short, damaged or of a newer version.
FileHeader decodeFileHeader(std::string_view bytes, const std::string& source);

/// Throws std::runtime_error if the payload has not the size [bytes] that the header states.
void checkPayloadSize(const FileHeader& header, std::uint64_t present, const std::string& source);

}  // namespace ambient
