#include "preprocess/base/fluid_body_writer.h"

#include <array>
#include <stdexcept>
#include <vector>

#include "bullet_ambient/base/fnv1a.h"
#include "fluid_body_generated.h"
#include "preprocess/base/output_file.h"

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

Offset<file::MassDistribution> pack(FlatBufferBuilder& builder, const MassDistribution& mass) {
  const auto centre = packMatrix<file::Vector3>(mass.centre);
  const auto inertia = packMatrix<file::Matrix3>(mass.inertia);
  return file::CreateMassDistribution(builder, &centre, &inertia);
}

Offset<file::Provenance> pack(FlatBufferBuilder& builder, const Provenance& provenance) {
  const auto source = builder.CreateString(provenance.source);
  const auto settings = builder.CreateString(provenance.settings);
  const auto generator = builder.CreateString(provenance.generator);
  Offset<flatbuffers::Vector<Offset<flatbuffers::String>>> said;
  if (!provenance.said.empty()) said = builder.CreateVectorOfStrings(provenance.said);
  return file::CreateProvenance(builder, source, provenance.source_hash, settings, generator, said);
}

/// `has_sharpness`: false leaves that column out.
Offset<file::FaceTable> pack(FlatBufferBuilder& builder, const FaceTable& faces,
                             bool has_sharpness = true) {
  std::array<Offset<flatbuffers::Vector<double>>, 7> c;
  for (std::size_t k = 0; k < c.size(); ++k) c[k] = builder.CreateVector(*faces.columns()[k]);
  Offset<flatbuffers::Vector<float>> sharpness;
  if (has_sharpness && !faces.sharpness.empty())
    sharpness = builder.CreateVector<float>(
        std::vector<float>(faces.sharpness.begin(), faces.sharpness.end()));
  return file::CreateFaceTable(builder, c[0], c[1], c[2], c[3], c[4], c[5], c[6], sharpness);
}

Offset<file::Surface> pack(FlatBufferBuilder& builder, const Surface& surface) {
  const auto vertices = builder.CreateVector(surface.vertices);
  const auto triangles = builder.CreateVector(surface.triangles.get());
  return file::CreateSurface(builder, vertices, triangles);
}

template <std::size_t kCount>
Offset<flatbuffers::Vector<double>> packNumbers(FlatBufferBuilder& builder,
                                                const std::array<const double*, kCount>& numbers) {
  return builder.CreateVector<double>(kCount, [&](std::size_t i) { return *numbers[i]; });
}

Offset<file::SurfaceForm> pack(FlatBufferBuilder& builder, const SurfaceForm& form) {
  if (form.faces.size() == 0 && form.hull.empty()) return 0;
  const auto shape = packNumbers(builder, form.shape.numbers());
  const auto faces = pack(builder, form.faces, false);
  const auto sharpness = builder.CreateVector(form.faces.sharpness);
  const auto hull = builder.CreateVector(form.hull.get());
  return file::CreateSurfaceForm(builder, shape, faces, sharpness, hull);
}

Offset<file::ViscousForm> pack(FlatBufferBuilder& builder, const ViscousForm& form) {
  if (!form.isKnown()) return 0;
  const auto numbers = packNumbers(builder, form.numbers());
  return file::CreateViscousForm(builder, numbers, form.is_primitive);
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

Offset<flatbuffers::Vector<Offset<file::Hold>>> pack(FlatBufferBuilder& builder,
                                                     const std::vector<Hold>& holds) {
  if (holds.empty()) return 0;
  std::vector<Offset<file::Hold>> packed;
  for (const Hold& hold : holds) {
    std::vector<Offset<file::HoldOpening>> openings;
    for (const HoldOpening& opening : hold.openings) {
      const auto outline = builder.CreateVector(opening.outline);
      const auto lid = builder.CreateVector(opening.lid);
      openings.push_back(file::CreateHoldOpening(builder, outline, lid, opening.to));
    }
    const auto name = builder.CreateString(hold.name);
    const auto surface = pack(builder, hold.surface);
    const auto all_openings = builder.CreateVector(openings);
    const auto centre = packMatrix<file::Vector3>(hold.centre);
    const auto turning_inertia = packMatrix<file::Matrix3>(hold.turning_inertia);
    packed.push_back(file::CreateHold(builder, name, surface, hold.volume, &centre,
                                      &turning_inertia, all_openings));
  }
  return builder.CreateVector(packed);
}

Offset<flatbuffers::Vector<Offset<file::Wing>>> pack(FlatBufferBuilder& builder,
                                                     const std::vector<Wing>& wings) {
  if (wings.empty()) return 0;
  std::vector<Offset<file::Wing>> packed;
  for (const Wing& wing : wings) {
    const auto name = builder.CreateString(wing.name);
    const auto numbers = packNumbers(builder, wing.numbers());
    packed.push_back(
        file::CreateWing(builder, name, numbers, wing.is_joined, wing.camber, wing.nose));
  }
  return builder.CreateVector(packed);
}

Offset<file::WingForm> packWingForm(FlatBufferBuilder& builder, const SurfaceForm& form) {
  if (form.part_of_face.empty()) return 0;
  const auto part_of_face = builder.CreateVector(form.part_of_face);
  const auto rest = packNumbers(builder, form.rest.numbers());
  const auto wing_shares = builder.CreateVector(form.wing_shares);
  return file::CreateWingForm(builder, part_of_face, rest, wing_shares);
}

void packInto(FlatBufferBuilder& builder, const FluidBody& body) {
  builder.ForceDefaults(true);  // else -0.0 would come back as +0.0
  const auto name = builder.CreateString(body.name);
  const auto provenance = pack(builder, body.provenance);
  const auto uniform_mass = pack(builder, body.uniform_mass);
  const auto surface_mass = pack(builder, body.surface_mass);
  const auto faces = pack(builder, facesOf(body));
  const auto surface = pack(builder, body.surface);
  const auto form_levels = pack(builder, body.form_levels);
  const auto parts = pack(builder, body.added_mass_parts.all());
  const auto waterline = pack(builder, body.waterline);
  const auto form = pack(builder, body.form);
  const auto viscous = pack(builder, body.viscous);
  const auto holds = pack(builder, body.holds);
  const auto wings = pack(builder, body.wings);
  Offset<flatbuffers::Vector<std::uint8_t>> part_of_triangle;
  if (!body.wings.empty()) part_of_triangle = builder.CreateVector(body.part_of_triangle);
  const auto wing_form = packWingForm(builder, body.form);
  const auto added_mass = packMatrix<file::Matrix6>(body.added_mass);
  const auto centre_of_volume = packMatrix<file::Vector3>(body.centre_of_volume);
  const auto origin = packMatrix<file::Vector3>(body.origin);
  flatbuffers::Optional<double> sphere_radius = flatbuffers::nullopt;
  if (body.sphere_radius > 0) sphere_radius = body.sphere_radius;
  const auto drag = packMatrix<file::Vector3>(body.drag);
  file::FinishFluidBodyBuffer(
      builder, file::CreateFluidBody(
                   builder, name, provenance, &added_mass, body.asymmetry, body.volume, body.area,
                   &centre_of_volume, &origin, uniform_mass, surface_mass, faces, surface,
                   sphere_radius, form_levels, body.drag.isZero(0) ? nullptr : &drag, parts,
                   waterline, form, viscous, holds, wings, part_of_triangle, wing_form));
}

std::size_t numbersIn(const FaceTable& faces) {
  std::size_t numbers = faces.sharpness.size();
  for (const std::vector<double>* column : faces.columns()) numbers += column->size();
  return numbers;
}

/// Upper bound of the bytes of a hold.
std::size_t boundOf(const Hold& hold) {
  constexpr std::size_t kFixedPart = 512;
  std::size_t bound = kFixedPart + hold.name.size() +
                      hold.surface.vertices.size() * sizeof(double) +
                      hold.surface.triangles.size() * sizeof(std::int32_t);
  for (const HoldOpening& opening : hold.openings)
    bound += kFixedPart + opening.outline.size() * sizeof(double) +
             opening.lid.size() * sizeof(std::int32_t);
  return bound;
}

/// Upper bound of the payload's size [bytes].
std::size_t payloadBound(const FluidBody& body) {
  constexpr std::size_t kFixedPart = 4096;
  std::size_t doubles = body.surface.vertices.size() + numbersIn(facesOf(body)) +
                        numbersIn(body.form.faces) + FormShape::kNumbers + ViscousForm::kNumbers;
  std::size_t level_bytes = 0;
  for (const FormLevel& level : body.form_levels)
    level_bytes += kFixedPart + numbersIn(level.faces) * sizeof(double);
  level_bytes += body.added_mass_parts.size() * AddedMassPart::kNumbers * sizeof(float);
  level_bytes += body.waterline.corrections.size() * kSymmetricNumbers * sizeof(float) +
                 body.waterline.immersions.size() * sizeof(double);
  for (const Hold& hold : body.holds) level_bytes += boundOf(hold);
  for (const Wing& wing : body.wings)
    level_bytes += kFixedPart / 8 + wing.name.size() + Wing::kNumbers * sizeof(double);
  for (const std::string& line : body.provenance.said) level_bytes += line.size() + kFixedPart / 64;
  level_bytes += body.part_of_triangle.size() + body.form.part_of_face.size();
  return kFixedPart + level_bytes + sizeof(double) * doubles +
         sizeof(std::int32_t) * (body.surface.triangles.size() + body.form.hull.size()) +
         body.name.size() + body.provenance.source.size() + body.provenance.settings.size() +
         body.provenance.generator.size();
}

/// Oldest format version that can hold the body: older programs can then read the file.
std::uint32_t versionFor(const FluidBody& body) {
  constexpr std::uint32_t kSpheres = 3;
  if (!body.holds.empty()) return kFormatVersion;
  return body.sphere_radius > 0 ? kSpheres : 1;
}

void appendLittleEndian(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xff);
}

}  // namespace

std::string encodeFileHeader(const FileHeader& header) {
  std::string bytes(kFileMagic);
  appendLittleEndian(bytes, header.version, 4);
  appendLittleEndian(bytes, 0, 4);
  appendLittleEndian(bytes, header.payload_size, 8);
  appendLittleEndian(bytes, header.payload_checksum, 8);
  return bytes;
}

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

void writeFluidBody(const FluidBody& body, const std::filesystem::path& file) {
  writeFile(file, encodeFluidBody(body, file.string()));
}

}  // namespace ambient
