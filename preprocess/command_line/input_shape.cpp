#include "preprocess/command_line/input_shape.h"

#include <algorithm>
#include <cctype>

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
  if (options.wrap) wrapSizeOf(*options.wrap);
}

MeshShape withStandIn(MeshShape mesh, const InputOptions& options) {
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

ShapeDescription describeInput(const std::filesystem::path& input, const InputOptions& options) {
  requireOne(options);
  if (!hasExtension(input, ".json")) {
    ShapeDescription mesh;
    if (options.sheet) {
      mesh.geometry = MeshSheetShape{input, 1};
    } else {
      mesh.geometry = withStandIn({input, 1}, options);
    }
    mesh.source = input.string();
    return mesh;
  }
  ShapeDescription shape = readShapeFile(input);
  if (std::holds_alternative<FluidBodyShape>(shape.geometry)) {
    raiseInputError(shape.source, "a shape \"fluid_body\" is built already");
  }
  if (options.sheet && !isSheet(shape)) {
    raiseInputError(shape.source, "--sheet needs a shape of type \"sheet\"");
  }
  if (const auto* mesh = std::get_if<MeshShape>(&shape.geometry)) {
    shape.geometry = withStandIn(*mesh, options);
  } else if (options.hull || options.wrap) {
    raiseInputError(shape.source, options.hull ? "--hull" : "--wrap",
                    " needs a mesh, or a shape of type \"mesh\"");
  }
  return shape;
}

}  // namespace ambient
