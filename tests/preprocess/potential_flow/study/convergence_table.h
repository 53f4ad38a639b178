#pragma once

#include <string>

namespace ambient::study {

/// Markdown: errors on four meshes each of a smooth body, a cube and a sheet, and the order of the
/// error in the size of the panels from one to the next.
std::string convergenceTable();

}  // namespace ambient::study
