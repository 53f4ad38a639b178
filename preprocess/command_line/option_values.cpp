#include "preprocess/command_line/option_values.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <system_error>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/output_file.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/polar/polar.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {

namespace {

Vector3 parseAxis(const char* option, const std::string& text) {
  try {
    return axisNamed(text);
  } catch (const std::invalid_argument& error) {
    raiseUsageError(option, error.what());
  }
}

}  // namespace

void requirePositive(const char* option, double value, const char* unit) {
  if (std::isfinite(value) && value > 0) return;
  raiseUsageError(option, value, unit, " must be finite and positive");
}

void requireNotNegative(const char* option, double value, const char* unit) {
  if (std::isfinite(value) && value >= 0) return;
  raiseUsageError(option, value, unit, " must be finite and not negative");
}

void requireMedium(const Medium& medium) {
  if (const auto fault = faultOf(medium))
    raiseUsageError(std::string("--") + fault->quantity, fault->value, " ", fault->unit,
                    " must be ", fault->limit);
}

void requireThreads(int threads) {
  constexpr int kMostThreads = 256;
  if (threads < 0) raiseUsageError("--threads", threads, " is below 0 (0: all cores)");
  if (threads > kMostThreads) raiseUsageError("--threads", threads, " is above ", kMostThreads);
}

void requireDivisions(const char* option, int count) {
  if (count < 0) raiseUsageError(option, count, " is below 0 (0: no division)");
  if (count > kMostDivisions) raiseUsageError(option, count, " is above ", kMostDivisions);
}

double wrapSizeOf(const std::string& text) {
  if (text == kDefaultWrap) return 0;
  char* end = nullptr;
  const double size = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    raiseUsageError("--wrap", "\"", text, "\" is not a size in metres");
  requirePositive("--wrap", size, " m");
  return size;
}

void addFlowOptions(CLI::App& command, FlowOptions& options) {
  addOption(command, "--roughness", options.roughness, "K",
            "Height of the roughness of the surface [m] (default 0: smooth)");
  addOption(command, "--separation-angle", options.separation_angle, "RAD",
            "From pi/2 (default) to pi, of the published law; larger = more attachment");
  addOption(command, "--law", options.law, "LAW", "Of the pressure: form (default) or published");
}

FlowSettings flowOf(const FlowOptions& options) {
  // An angle given with a few digits is still a right or a straight one.
  constexpr double kRight = kPi / 2, kDigits = 1e-6;
  const double angle = options.separation_angle;
  if (!(angle >= kRight * (1 - kDigits) && angle <= kPi * (1 + kDigits)))
    raiseUsageError("--separation-angle", angle, " rad must lie between pi/2 and pi");
  requireNotNegative("--roughness", options.roughness, " m");
  const auto law = valueOf(kPressureLawNames, options.law);
  if (!law) raiseUsageError("--law", "\"", options.law, "\" is neither published nor form");
  FlowSettings flow;
  flow.roughness = options.roughness;
  flow.separation_angle = std::clamp(angle, kRight, kPi);
  flow.law = *law;
  if (flow.law == PressureLaw::kForm && angle > kRight * (1 + kDigits))
    std::cerr << "ambient_preprocess: --separation-angle: only --law published reads it\n";
  return flow;
}

Matrix3 flightAxesOf(const std::string& forward, const std::string& up) {
  const Vector3 ahead = parseAxis("--forward", forward), above = parseAxis("--up", up);
  if (ahead.dot(above) != 0) raiseUsageError("--up", up, " is along --forward ", forward);
  return flightAxes(ahead, above);
}

namespace {

void requireOne(const InputOptions& options) {
  if (options.hull && options.wrap) raiseUsageError("--wrap", "excludes --hull");
  if (options.sheet && (options.hull || options.wrap))
    raiseUsageError("--sheet", "excludes --hull and --wrap, which make bodies");
  if (options.wrap && options.strict) raiseUsageError("--wrap", "excludes --strict");
  if (options.wrap) wrapSizeOf(*options.wrap);
}

MeshFile withStandIn(MeshFile mesh, const InputOptions& options) {
  mesh.strict = mesh.strict || options.strict;
  mesh.sheet = options.sheet;
  if (options.hull) mesh.stand_in = MeshStandIn::kHull;
  if (options.wrap) {
    mesh.stand_in = MeshStandIn::kWrap;
    mesh.wrap_size = wrapSizeOf(*options.wrap) / options.scale;
  }
  return mesh;
}

}  // namespace

bool hasExtension(const std::filesystem::path& file, const std::string& extension) {
  std::string own = file.extension().string();
  std::transform(own.begin(), own.end(), own.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return own == extension;
}

void addInputOptions(CLI::App& command, InputOptions& options) {
  addOption(command, "--scale", options.scale, "S", "Multiplies all lengths (default 1)");
  command.add_flag("--sheet", options.sheet, "The mesh is an open surface of zero thickness");
  command.add_flag("--hull", options.hull, "Take the convex hull of the mesh");
  command
      .add_option_function<std::string>(
          "--wrap", [&options](const std::string& size) { options.wrap = size; },
          "Take a closed surface around the mesh, which may be open, overlapping, or in parts; "
          "gaps and details below SIZE vanish (default 1/100 of its diagonal)")
      ->type_name("[SIZE]");
  command.add_flag(
      "--strict", options.strict,
      "Refuse a mesh that is not a closed body after mending, in place of --wrap with a "
      "warning");
  addOption(command, "--holds", options.holds, "auto|none",
            "Rooms that hold water stay dry, or the body is that of its walls (default auto)");
  addOption(command, "--up", options.up, "X Y Z",
            "Which way the mesh stands when holds are found (default: the axis with the largest)")
      ->expected(3);
}

HoldSearch holdsOf(const InputOptions& options) {
  if (options.holds != "auto" && options.holds != "none")
    raiseUsageError("--holds", "\"", options.holds, "\" is neither auto nor none");
  HoldSearch search;
  search.is_wanted = options.holds == "auto";
  if (options.up.empty()) return search;
  const Eigen::Vector3d up = Eigen::Map<const Eigen::Vector3d>(options.up.data());
  if (!up.allFinite() || up.isZero(0)) raiseUsageError("--up", up.transpose(), " is no direction");
  search.up = up.stableNormalized();
  return search;
}

ShapeDescription describeInput(const std::filesystem::path& input, const InputOptions& options) {
  requireOne(options);
  if (!hasExtension(input, ".json")) {
    ShapeDescription mesh;
    mesh.geometry = withStandIn({input, 1}, options);
    mesh.source = input.string();
    return mesh;
  }
  ShapeDescription shape = readShapeFile(input);
  if (std::holds_alternative<FluidBodyFile>(shape.geometry)) {
    raiseInputError(shape.source, "a shape \"fluid_body\" is built already");
  }
  if (options.sheet && !isSheet(shape)) {
    raiseInputError(shape.source, "--sheet needs a shape of type \"sheet\"");
  }
  if (const auto* mesh = std::get_if<MeshFile>(&shape.geometry); mesh && !mesh->sheet) {
    shape.geometry = withStandIn(*mesh, options);
  } else if (options.hull || options.wrap) {
    raiseInputError(shape.source, options.hull ? "--hull" : "--wrap",
                    " needs a mesh, or a shape of type \"mesh\"");
  }
  return shape;
}

void requireWritablePlace(const std::filesystem::path& output, const std::filesystem::path& input) {
  std::error_code error;
  const std::filesystem::path target = linkTarget(output);
  const std::filesystem::path folder = target.parent_path().empty() ? "." : target.parent_path();
  if (!std::filesystem::is_directory(folder, error)) {
    raiseInputError(output.string(), "the directory ", folder, " does not exist");
  }
  if (std::filesystem::status(target, error).type() == std::filesystem::file_type::none)
    raiseInputError(output.string(), "cannot be written: ", error.message());
  if (std::filesystem::is_directory(target, error))
    raiseInputError(output.string(), "is a directory");
  if (std::filesystem::equivalent(output, input, error)) {
    raiseInputError(output.string(), "the output would replace the input");
  }
}

void requireReplaceable(const std::filesystem::path& output) {
  std::error_code error;
  if (hasExtension(output, ".ambient") || !std::filesystem::is_regular_file(output, error)) return;
  std::string bytes(kFileHeaderSize, '\0');
  std::ifstream stream(output, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (bytes.empty()) return;
  try {
    static_cast<void>(decodeFileHeader(bytes, output.string()));
  } catch (const std::runtime_error& foreign) {
    throw std::runtime_error(std::string(foreign.what()) + ", and is not replaced");
  }
}

}  // namespace ambient
