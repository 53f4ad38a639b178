#pragma once

#include <string>

namespace ambient::study {

/// Markdown: errors on four meshes each of a smooth body, a cube and a sheet. Columns of order:
/// error against panel size from mesh to mesh.
std::string convergenceTable();

}  // namespace ambient::study
