#include "bullet_ambient/fluid_body/file/fluid_body_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/plain_text.h"
#include "fluid_body_generated.h"

namespace ambient {

namespace {

/// @param source names the file
template <class... Parts>
[[noreturn]] void fail(const std::string& source, const Parts&... parts) {
  std::ostringstream line;
  line << source << ": ";
  (line << ... << parts);
  throw std::runtime_error(plainLine(line.str()));
}

template <class Matrix, class Struct>
Matrix unpackMatrix(const Struct& packed) {
  Matrix matrix;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index col = 0; col < matrix.cols(); ++col)
      matrix(row, col) =
          packed.values()->Get(static_cast<flatbuffers::uoffset_t>(row * matrix.cols() + col));
  return matrix;
}

// Copies an element bytewise: the verifier does not check the alignment of elements.
template <class T>
T elementOf(const flatbuffers::Vector<T>& packed, std::size_t i) {
  T value;
  std::memcpy(&value, packed.Data() + i * sizeof value, sizeof value);
  return flatbuffers::EndianScalar(value);
}

template <class T>
std::vector<T> unpackVector(const flatbuffers::Vector<T>& packed) {
  std::vector<T> values(packed.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = elementOf(packed, i);
  return values;
}

MassDistribution unpack(const file::MassDistribution& packed) {
  return {unpackMatrix<Vector3>(*packed.centre()), unpackMatrix<Matrix3>(*packed.inertia())};
}

Provenance unpack(const file::Provenance& packed) {
  Provenance provenance{packed.source()->str(), packed.source_hash(), packed.settings()->str(),
                        packed.generator()->str()};
  if (packed.said())
    for (const flatbuffers::String* line : *packed.said()) provenance.said.push_back(line->str());
  return provenance;
}

FaceTable unpack(const file::FaceTable& packed) {
  FaceTable faces{unpackVector(*packed.normal_x()),   unpackVector(*packed.normal_y()),
                  unpackVector(*packed.normal_z()),   unpackVector(*packed.centroid_x()),
                  unpackVector(*packed.centroid_y()), unpackVector(*packed.centroid_z()),
                  unpackVector(*packed.area()),       {}};
  if (packed.sharpness()) {
    const std::vector<float> sharpness = unpackVector(*packed.sharpness());
    faces.sharpness.assign(sharpness.begin(), sharpness.end());
  }
  return faces;
}

Surface unpack(const file::Surface& packed) {
  return {unpackVector(*packed.vertices()), unpackVector(*packed.triangles())};
}

/// @param what has the numbers, for messages
template <std::size_t kCount>
void unpackNumbers(const flatbuffers::Vector<double>& packed, const std::string& source,
                   const char* what, const std::array<double*, kCount>& numbers) {
  if (packed.size() != kCount)
    fail(source, what, " has ", packed.size(), " numbers, but must have ", kCount);
  for (std::size_t i = 0; i < kCount; ++i) *numbers[i] = elementOf(packed, i);
}

SurfaceForm unpack(const file::SurfaceForm& packed, const std::string& source) {
  SurfaceForm form;
  unpackNumbers(*packed.shape(), source, "its form", form.shape.numbers());
  form.faces = unpack(*packed.faces());
  form.faces.sharpness = unpackVector(*packed.sharpness());
  form.hull = unpackVector(*packed.hull());
  return form;
}

ViscousForm unpack(const file::ViscousForm& packed, const std::string& source) {
  ViscousForm form;
  unpackNumbers(*packed.numbers(), source, "its viscous form", form.numbers());
  form.is_primitive = packed.is_primitive();
  return form;
}

constexpr std::size_t kSymmetricNumbers = 21;  // entries of the upper triangle of 6x6

template <typename Next>
Matrix6 readSymmetric(const Next& next) {
  Matrix6 matrix;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) matrix(row, column) = matrix(column, row) = next();
  return matrix;
}

std::vector<AddedMassPart> unpackParts(const flatbuffers::Vector<float>& packed,
                                       const std::string& source) {
  if (packed.size() % AddedMassPart::kNumbers != 0)
    fail(source, "the parts of its added mass are ", packed.size(),
         " numbers, but must be a multiple of ", int{AddedMassPart::kNumbers});
  std::vector<AddedMassPart> parts(packed.size() / AddedMassPart::kNumbers);
  std::size_t at = 0;
  const auto next = [&] { return static_cast<double>(elementOf(packed, at++)); };
  for (AddedMassPart& part : parts) {
    for (double& value : part.centre) value = next();
    for (double& value : part.spread) value = next();
    part.inertia = readSymmetric(next);
  }
  return parts;
}

WaterlineTable unpack(const file::WaterlineTable& packed, const std::string& source) {
  const flatbuffers::Vector<float>& numbers = *packed.corrections();
  if (numbers.size() % kSymmetricNumbers != 0)
    fail(source, "the corrections of its waterline table are ", numbers.size(),
         " numbers, but must be a multiple of ", kSymmetricNumbers);
  WaterlineTable table{packed.subdivisions(), unpackVector(*packed.immersions()), {}};
  std::size_t at = 0;
  const auto next = [&] { return static_cast<double>(elementOf(numbers, at++)); };
  table.corrections.resize(numbers.size() / kSymmetricNumbers);
  for (Matrix6& correction : table.corrections) correction = readSymmetric(next);
  return table;
}

Hold unpack(const file::Hold& packed) {
  Hold hold;
  hold.name = packed.name()->str();
  hold.surface = unpack(*packed.surface());
  hold.volume = packed.volume();
  hold.centre = unpackMatrix<Vector3>(*packed.centre());
  hold.turning_inertia = unpackMatrix<Matrix3>(*packed.turning_inertia());
  for (const file::HoldOpening* opening : *packed.openings())
    hold.openings.push_back(
        {unpackVector(*opening->outline()), unpackVector(*opening->lid()), opening->to()});
  return hold;
}

Wing unpack(const file::Wing& packed, const std::string& source) {
  Wing wing;
  wing.name = packed.name()->str();
  unpackNumbers(*packed.numbers(), source, "a wing", wing.numbers());
  wing.is_joined = packed.is_joined();
  wing.camber = packed.camber();
  wing.nose = packed.nose();
  return wing;
}

void unpackWings(const file::FluidBody& packed, const std::string& source, FluidBody& body) {
  if (!packed.wings()) return;
  for (const file::Wing* wing : *packed.wings()) body.wings.push_back(unpack(*wing, source));
  if (packed.part_of_triangle()) body.part_of_triangle = unpackVector(*packed.part_of_triangle());
  if (!packed.wing_form()) return;
  const file::WingForm& form = *packed.wing_form();
  body.form.part_of_face = unpackVector(*form.part_of_face());
  unpackNumbers(*form.rest(), source, "the rest beside its wings", body.form.rest.numbers());
  body.form.wing_shares = unpackVector(*form.wing_shares());
}

FluidBody unpack(const file::FluidBody& packed, const std::string& source) {
  FluidBody body;
  body.name = packed.name()->str();
  body.provenance = unpack(*packed.provenance());
  body.added_mass = unpackMatrix<Matrix6>(*packed.added_mass());
  body.asymmetry = packed.asymmetry();
  body.volume = packed.volume();
  body.area = packed.area();
  body.centre_of_volume = unpackMatrix<Vector3>(*packed.centre_of_volume());
  body.origin = unpackMatrix<Vector3>(*packed.origin());
  body.uniform_mass = unpack(*packed.uniform_mass());
  body.surface_mass = unpack(*packed.surface_mass());
  body.faces = unpack(*packed.faces());
  body.surface = unpack(*packed.surface());
  if (packed.form_levels())
    for (const file::FormLevel* level : *packed.form_levels())
      body.form_levels.push_back(
          {unpack(*level->faces()), level->p99_error(), level->law_revision()});
  body.sphere_radius = packed.sphere_radius().value_or(0);
  if (packed.drag()) body.drag = unpackMatrix<Vector3>(*packed.drag());
  if (packed.added_mass_parts())
    body.added_mass_parts = unpackParts(*packed.added_mass_parts(), source);
  if (packed.waterline()) body.waterline = unpack(*packed.waterline(), source);
  if (packed.form()) body.form = unpack(*packed.form(), source);
  if (packed.viscous()) body.viscous = unpack(*packed.viscous(), source);
  if (packed.holds())
    for (const file::Hold* hold : *packed.holds()) body.holds.push_back(unpack(*hold));
  unpackWings(packed, source, body);
  return body;
}

bool isAligned(const char* address) {
  return reinterpret_cast<std::uintptr_t>(address) % alignof(double) == 0;
}

}  // namespace

FluidBody decodeFluidBody(std::string_view bytes, const std::string& source) {
  const FileHeader header = decodeFileHeader(bytes, source);
  const std::string_view payload = bytes.substr(kFileHeaderSize);
  checkPayloadSize(header, payload.size(), source);
  if (fnv1a64(payload) != header.payload_checksum)
    fail(source, "damaged: the checksum of its ", payload.size(), " byte payload does not match");

  std::vector<double> aligned;
  const char* data = payload.data();
  if (!isAligned(data)) {
    aligned.resize(payload.size() / sizeof(double) + 1);
    std::memcpy(aligned.data(), payload.data(), payload.size());
    data = reinterpret_cast<const char*>(aligned.data());
  }
  const auto* buffer = reinterpret_cast<const std::uint8_t*>(data);
  flatbuffers::Verifier verifier(buffer, payload.size());
  if (!file::VerifyFluidBodyBuffer(verifier))
    fail(source, "damaged: its payload is not a fluid body of format version ", header.version);
  FluidBody body = unpack(*file::GetFluidBody(buffer), source);
  checkFluidBody(body, source);
  return body;
}

namespace {

std::uint64_t littleEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;)
    value = (value << 8) | static_cast<unsigned char>(bytes[i]);
  return value;
}

}  // namespace

FileHeader decodeFileHeader(std::string_view bytes, const std::string& source) {
  if (bytes.empty()) fail(source, "the file is empty");
  if (bytes.substr(0, kFileMagic.size()) != kFileMagic.substr(0, bytes.size()))
    fail(source, "not a .ambient file: it does not begin with the mark of one");
  if (bytes.size() < kFileHeaderSize)
    fail(source, "truncated: ", bytes.size(), " bytes, but the header alone has ", kFileHeaderSize);

  FileHeader header;
  header.version = static_cast<std::uint32_t>(littleEndian(bytes.substr(8, 4)));
  header.payload_size = littleEndian(bytes.substr(16, 8));
  header.payload_checksum = littleEndian(bytes.substr(24, 8));
  if (header.version > kFormatVersion)
    fail(source, "format version ", header.version, " is newer than this program reads, limit ",
         kFormatVersion);
  if (header.version == 0 || littleEndian(bytes.substr(12, 4)) != 0)
    fail(source, "damaged: its header is not valid");
  return header;
}

void checkPayloadSize(const FileHeader& header, std::uint64_t present, const std::string& source) {
  if (header.payload_size > kPayloadLimit)
    fail(source, "damaged: a payload of ", header.payload_size, " bytes is announced, limit ",
         kPayloadLimit);
  if (present != header.payload_size)
    fail(source, present < header.payload_size ? "truncated: " : "damaged: ", present,
         " bytes follow the header, which announces ", header.payload_size);
}

namespace {

namespace fs = std::filesystem;

std::uint64_t sizeOfRegularFile(const fs::path& path) {
  const std::string file = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail(file, "no such file");
  if (error) fail(file, "cannot be read: ", error.message());
  if (fs::is_directory(status)) fail(file, "is a directory, not a .ambient file");
  if (!fs::is_regular_file(status)) fail(file, "is not a regular file");
  const std::uint64_t size = fs::file_size(path, error);
  if (error) fail(file, "cannot be read: ", error.message());
  return size;
}

std::string readBytes(const fs::path& file) {
  const std::uint64_t size = sizeOfRegularFile(file);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file.string(), "cannot be opened: ", std::strerror(errno));

  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(size, kFileHeaderSize)), '\0');
  const auto read = [&](std::size_t from) {
    stream.read(bytes.data() + from, static_cast<std::streamsize>(bytes.size() - from));
    bytes.resize(from + static_cast<std::size_t>(stream.gcount()));
  };
  read(0);
  // The whole file is allocated only after the header has been checked.
  const FileHeader header = decodeFileHeader(bytes, file.string());
  checkPayloadSize(header, size - kFileHeaderSize, file.string());
  bytes.resize(static_cast<std::size_t>(size));
  read(kFileHeaderSize);
  return bytes;
}

}  // namespace

FluidBody readFluidBody(const fs::path& file) {
  return decodeFluidBody(readBytes(file), file.string());
}

std::shared_ptr<const FluidBody> loadFluidBody(const std::string& file) {
  return std::make_shared<FluidBody>(readFluidBody(file));
}

}  // namespace ambient
