#include "preprocess/command_line/fluid_body_report.h"

#include <cstdio>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/plain_text.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {

namespace {

using nlohmann::ordered_json;

std::string compact(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string valueText(const ordered_json& value) {
  const bool is_matrix = value.is_array() && !value.empty() && value.front().is_array();
  if (!is_matrix) return compact(value);
  std::string text = "[";
  for (std::size_t row = 0; row < value.size(); ++row) {
    text += (row > 0 ? ",\n    " : "\n    ") + compact(value[row]);
  }
  return text + "\n  ]";
}

}  // namespace

std::string jsonText(const ordered_json& object) {
  std::string text = "{";
  for (const auto& entry : object.items()) {
    text += text.size() > 1 ? ",\n  " : "\n  ";
    text += compact(entry.key()) + ": " + valueText(entry.value());
  }
  return text + "\n}\n";
}

namespace {

using nlohmann::ordered_json;

ordered_json massJson(const MassDistribution& mass) {
  return {{"centre", vectorJson(mass.centre)}, {"inertia", matrixJson(mass.inertia)}};
}

ordered_json levelsJson(const std::vector<FormLevel>& levels) {
  ordered_json list = ordered_json::array();
  for (const FormLevel& level : levels)
    list.push_back({{"faces", level.faces.size()}, {"p99_error", level.p99_error}});
  return list;
}

bool isSheet(const FluidBody& body) { return body.volume == 0; }

/// Rows "label  value" of a table.
class Table {
 public:
  explicit Table(const std::string& title) { text_ << std::setprecision(9) << title << "\n"; }

  template <class... Parts>
  void row(const std::string& label, const Parts&... parts) {
    text_ << "  " << std::left << std::setw(18) << label;
    (text_ << ... << parts) << "\n";
  }

  void matrix(const std::string& label, const Matrix6& matrix) {
    text_ << "  " << label << "\n";
    for (int i = 0; i < 6; ++i) {
      text_ << "  ";
      for (int j = 0; j < 6; ++j) {
        char number[32];
        std::snprintf(number, sizeof number, " %14.6e", matrix(i, j));
        text_ << number;
      }
      text_ << "\n";
    }
  }

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

std::string vectorText(const Vector3& v) {
  std::ostringstream text;
  text << std::setprecision(9) << v.x() << ", " << v.y() << ", " << v.z();
  return text.str();
}

}  // namespace

std::string reportJson(const FluidBody& body, std::optional<double> seconds) {
  ordered_json report{{"name", body.name},
                      {"vertices", body.surface.vertices.size() / 3},
                      {"faces", body.surface.triangles.size() / 3},
                      {"sheet", isSheet(body)},
                      {"size", vectorJson(extentsOf(body))},
                      {"volume", body.volume},
                      {"area", body.area},
                      {"origin", vectorJson(body.origin)},
                      {"centre_of_volume", vectorJson(body.centre_of_volume)},
                      {"added_mass", matrixJson(body.added_mass)},
                      {"asymmetry", body.asymmetry},
                      {"uniform_mass", massJson(body.uniform_mass)},
                      {"surface_mass", massJson(body.surface_mass)},
                      {"source", body.provenance.source},
                      {"source_hash", hashText(body.provenance.source_hash)},
                      {"settings", body.provenance.settings},
                      {"generator", body.provenance.generator}};
  if (!body.form_levels.empty()) report["form_levels"] = levelsJson(body.form_levels);
  if (!body.waterline.empty())
    report["waterline_table"] = {{"subdivisions", body.waterline.subdivisions},
                                 {"immersions", body.waterline.immersions.size()}};
  if (seconds) report["seconds"] = *seconds;
  return jsonText(report);
}

std::string reportTable(const FluidBody& body, const std::string& file) {
  Table table(plainLine(file) + ": " + extentsText(extentsOf(body)));
  table.row("name", plainLine(body.name));
  table.row("source", plainLine(body.provenance.source), "  [",
            hashText(body.provenance.source_hash), "]");
  table.row("settings", plainLine(body.provenance.settings));
  table.row("made by", plainLine(body.provenance.generator));
  table.row("vertices", body.surface.vertices.size() / 3);
  table.row("faces", body.surface.triangles.size() / 3, isSheet(body) ? ", a sheet" : "");
  table.row("volume", body.volume, " m^3");
  table.row("area", body.area, isSheet(body) ? " m^2, both sides" : " m^2");
  table.row("origin", vectorText(body.origin), " m in the mesh's frame");
  table.row("centre of volume", vectorText(body.centre_of_volume), " m");
  table.row("asymmetry", body.asymmetry, " of the added mass before it was made symmetric");
  for (const FormLevel& level : body.form_levels)
    table.row("form law, " + std::to_string(level.faces.size()) + " faces", "p99 ",
              100 * level.p99_error, " %");
  if (!body.waterline.empty())
    table.row("waterline table", body.waterline.corrections.size(), " attitudes and immersions");
  table.matrix("added mass per unit density, rotation first [m^5, m^4; m^4, m^3]", body.added_mass);
  return table.text();
}

}  // namespace ambient
