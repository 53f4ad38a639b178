#include "preprocess/command_line/input_shape.h"

#include <algorithm>
#include <cctype>

#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {
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
}

ShapeDescription describeInput(const std::filesystem::path& input, const InputOptions& options) {
  requireOne(options);
  if (!hasExtension(input, ".json")) {
    ShapeDescription mesh;
    if (options.sheet) {
      mesh.geometry = MeshSheet{input, 1};
    } else {
      mesh.geometry = withStandIn({input, 1}, options);
    }
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
  if (const auto* mesh = std::get_if<MeshFile>(&shape.geometry)) {
    shape.geometry = withStandIn(*mesh, options);
  } else if (options.hull || options.wrap) {
    raiseInputError(shape.source, options.hull ? "--hull" : "--wrap",
                    " needs a mesh, or a shape of type \"mesh\"");
  }
  return shape;
}

}  // namespace ambient
