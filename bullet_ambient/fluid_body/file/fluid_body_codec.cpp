#include <array>
#include <cstring>
#include <stdexcept>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "fluid_body_generated.h"

namespace ambient {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

template <class Struct, class Matrix>
Struct packMatrix(const Matrix& matrix) {
  constexpr int kRows = Matrix::RowsAtCompileTime;
  constexpr int kCols = Matrix::ColsAtCompileTime;
  std::array<double, kRows * kCols> rows;
  for (int row = 0; row < kRows; ++row)
    for (int col = 0; col < kCols; ++col) rows[row * kCols + col] = matrix(row, col);
  return Struct(flatbuffers::span<const double, kRows * kCols>(rows));
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

Offset<file::MassDistribution> pack(FlatBufferBuilder& builder, const MassDistribution& mass) {
  const auto centre = packMatrix<file::Vector3>(mass.centre);
  const auto inertia = packMatrix<file::Matrix3>(mass.inertia);
  return file::CreateMassDistribution(builder, &centre, &inertia);
}

MassDistribution unpack(const file::MassDistribution& packed) {
  return {unpackMatrix<Vector3>(*packed.centre()), unpackMatrix<Matrix3>(*packed.inertia())};
}

Offset<file::Provenance> pack(FlatBufferBuilder& builder, const Provenance& provenance) {
  const auto source = builder.CreateString(provenance.source);
  const auto settings = builder.CreateString(provenance.settings);
  const auto generator = builder.CreateString(provenance.generator);
  return file::CreateProvenance(builder, source, provenance.source_hash, settings, generator);
}

Provenance unpack(const file::Provenance& packed) {
  return {packed.source()->str(), packed.source_hash(), packed.settings()->str(),
          packed.generator()->str()};
}

Offset<file::FaceTable> pack(FlatBufferBuilder& builder, const FaceTable& faces) {
  std::array<Offset<flatbuffers::Vector<double>>, 7> c;
  for (std::size_t k = 0; k < c.size(); ++k) c[k] = builder.CreateVector(*faces.columns()[k]);
  Offset<flatbuffers::Vector<float>> sharpness;
  if (!faces.sharpness.empty())
    sharpness = builder.CreateVector<float>(
        std::vector<float>(faces.sharpness.begin(), faces.sharpness.end()));
  return file::CreateFaceTable(builder, c[0], c[1], c[2], c[3], c[4], c[5], c[6], sharpness);
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

Offset<file::Surface> pack(FlatBufferBuilder& builder, const Surface& surface) {
  const auto vertices = builder.CreateVector(surface.vertices);
  const auto triangles = builder.CreateVector(surface.triangles);
  return file::CreateSurface(builder, vertices, triangles);
}

Surface unpack(const file::Surface& packed) {
  return {unpackVector(*packed.vertices()), unpackVector(*packed.triangles())};
}

Offset<flatbuffers::Vector<Offset<file::FormLevel>>> pack(FlatBufferBuilder& builder,
                                                          const std::vector<FormLevel>& levels) {
  if (levels.empty()) return 0;
  std::vector<Offset<file::FormLevel>> packed;
  for (const FormLevel& level : levels) {
    const auto faces = pack(builder, level.faces);
    packed.push_back(file::CreateFormLevel(builder, faces, level.p99_error, level.law_revision));
  }
  return builder.CreateVector(packed);
}

constexpr std::size_t kSymmetricNumbers = 21;

/// Passes the upper triangle to add(), row by row.
template <typename Add>
void addSymmetric(const Matrix6& matrix, const Add& add) {
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) add(matrix(row, column));
}

template <typename Next>
Matrix6 takeSymmetric(const Next& next) {
  Matrix6 matrix;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) matrix(row, column) = matrix(column, row) = next();
  return matrix;
}

Offset<flatbuffers::Vector<float>> pack(FlatBufferBuilder& builder,
                                        const std::vector<AddedMassPart>& parts) {
  if (parts.empty()) return 0;
  std::vector<float> numbers;
  numbers.reserve(parts.size() * AddedMassPart::kNumbers);
  const auto add = [&](double value) { numbers.push_back(static_cast<float>(value)); };
  for (const AddedMassPart& part : parts) {
    for (const double value : part.centre) add(value);
    for (const double value : part.spread) add(value);
    addSymmetric(part.inertia, add);
  }
  return builder.CreateVector(numbers);
}

Offset<file::WaterlineTable> pack(FlatBufferBuilder& builder, const WaterlineTable& table) {
  if (table.empty()) return 0;
  std::vector<float> numbers;
  for (const Matrix6& correction : table.corrections)
    addSymmetric(correction, [&](double value) { numbers.push_back(static_cast<float>(value)); });
  const auto immersions = builder.CreateVector(table.immersions);
  const auto corrections = builder.CreateVector(numbers);
  return file::CreateWaterlineTable(builder, table.subdivisions, immersions, corrections);
}

std::vector<AddedMassPart> unpackParts(const flatbuffers::Vector<float>& packed,
                                       const std::string& source) {
  if (packed.size() % AddedMassPart::kNumbers != 0)
    throw std::runtime_error(
        source + ": the parts of its added mass are " + std::to_string(packed.size()) +
        " numbers, but must be a multiple of " + std::to_string(AddedMassPart::kNumbers));
  std::vector<AddedMassPart> parts(packed.size() / AddedMassPart::kNumbers);
  std::size_t at = 0;
  const auto next = [&] { return static_cast<double>(elementOf(packed, at++)); };
  for (AddedMassPart& part : parts) {
    for (double& value : part.centre) value = next();
    for (double& value : part.spread) value = next();
    part.inertia = takeSymmetric(next);
  }
  return parts;
}

WaterlineTable unpack(const file::WaterlineTable& packed, const std::string& source) {
  const flatbuffers::Vector<float>& numbers = *packed.corrections();
  if (numbers.size() % kSymmetricNumbers != 0)
    throw std::runtime_error(source + ": the corrections of its waterline table are " +
                             std::to_string(numbers.size()) +
                             " numbers, but must be a multiple of 21");
  WaterlineTable table{packed.subdivisions(), unpackVector(*packed.immersions()), {}};
  std::size_t at = 0;
  const auto next = [&] { return static_cast<double>(elementOf(numbers, at++)); };
  table.corrections.resize(numbers.size() / kSymmetricNumbers);
  for (Matrix6& correction : table.corrections) correction = takeSymmetric(next);
  return table;
}

void packInto(FlatBufferBuilder& builder, const FluidBody& body) {
  builder.ForceDefaults(true);  // else -0.0 would come back as +0.0
  const auto name = builder.CreateString(body.name);
  const auto provenance = pack(builder, body.provenance);
  const auto uniform_mass = pack(builder, body.uniform_mass);
  const auto surface_mass = pack(builder, body.surface_mass);
  const auto faces = pack(builder, body.faces);
  const auto surface = pack(builder, body.surface);
  const auto form_levels = pack(builder, body.form_levels);
  const auto parts = pack(builder, body.added_mass_parts);
  const auto waterline = pack(builder, body.waterline);
  const auto added_mass = packMatrix<file::Matrix6>(body.added_mass);
  const auto centre_of_volume = packMatrix<file::Vector3>(body.centre_of_volume);
  const auto origin = packMatrix<file::Vector3>(body.origin);
  flatbuffers::Optional<double> sphere_radius = flatbuffers::nullopt;
  if (body.sphere_radius > 0) sphere_radius = body.sphere_radius;
  const auto drag = packMatrix<file::Vector3>(body.drag);
  file::FinishFluidBodyBuffer(
      builder,
      file::CreateFluidBody(builder, name, provenance, &added_mass, body.asymmetry, body.volume,
                            body.area, &centre_of_volume, &origin, uniform_mass, surface_mass,
                            faces, surface, sphere_radius, form_levels,
                            body.drag.isZero(0) ? nullptr : &drag, parts, waterline));
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
  return body;
}

std::size_t numbersIn(const FaceTable& faces) {
  std::size_t numbers = faces.sharpness.size();
  for (const std::vector<double>* column : faces.columns()) numbers += column->size();
  return numbers;
}

/// Upper bound of the payload's size [bytes].
std::size_t payloadBound(const FluidBody& body) {
  constexpr std::size_t kFixedPart = 4096;
  std::size_t doubles = body.surface.vertices.size() + numbersIn(body.faces);
  std::size_t level_bytes = 0;
  for (const FormLevel& level : body.form_levels)
    level_bytes += kFixedPart + numbersIn(level.faces) * sizeof(double);
  level_bytes += body.added_mass_parts.size() * AddedMassPart::kNumbers * sizeof(float);
  level_bytes += body.waterline.corrections.size() * kSymmetricNumbers * sizeof(float) +
                 body.waterline.immersions.size() * sizeof(double);
  return kFixedPart + level_bytes + sizeof(double) * doubles +
         sizeof(std::int32_t) * body.surface.triangles.size() + body.name.size() +
         body.provenance.source.size() + body.provenance.settings.size() +
         body.provenance.generator.size();
}

/// Oldest format version that can hold the body: older programs can then read the file.
std::uint32_t versionFor(const FluidBody& body) {
  return body.sphere_radius > 0 ? kFormatVersion : 1;
}

bool isAligned(const char* address) {
  return reinterpret_cast<std::uintptr_t>(address) % alignof(double) == 0;
}

}  // namespace

std::string encodeFluidBody(const FluidBody& body, const std::string& source) {
  checkFluidBody(body, source);
  const std::size_t bound = payloadBound(body);
  if (bound > kPayloadLimit)
    throw std::runtime_error(source + ": the fluid body needs about " + std::to_string(bound) +
                             " bytes, limit " + std::to_string(kPayloadLimit));
  FlatBufferBuilder builder(bound);
  packInto(builder, body);
  const std::string_view payload(reinterpret_cast<const char*>(builder.GetBufferPointer()),
                                 builder.GetSize());
  std::string bytes = encodeFileHeader({versionFor(body), payload.size(), fnv1a64(payload)});
  bytes += payload;
  return bytes;
}

FluidBody decodeFluidBody(std::string_view bytes, const std::string& source) {
  const FileHeader header = decodeFileHeader(bytes, source);
  const std::string_view payload = bytes.substr(kFileHeaderSize);
  checkPayloadSize(header, payload.size(), source);
  if (fnv1a64(payload) != header.payload_checksum)
    throw std::runtime_error(source + ": damaged: the checksum of its " +
                             std::to_string(payload.size()) + " byte payload does not match");

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
    throw std::runtime_error(source +
                             ": damaged: its payload is not a fluid body of format version " +
                             std::to_string(header.version));
  FluidBody body = unpack(*file::GetFluidBody(buffer), source);
  checkFluidBody(body, source);
  return body;
}

}  // namespace ambient
