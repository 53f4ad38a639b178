#include "preprocess/command_line/fluid_body_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/force/law/viscous_law.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

/// Units for people, by key.
const std::map<std::string, const char*, std::less<>> kUnits{
    {"added_mass", "m^5, m^4; m^4, m^3, per unit density, rotation first"},
    {"area", "m^2"},
    {"barycentre", "m"},
    {"centre", "m"},
    {"chord", "m"},
    {"centre_of_reaction", "m"},
    {"centre_of_volume", "m"},
    {"damping", "of the critical one"},
    {"drag_falls_at", "Reynolds number on D_A, of both ways"},
    {"draught", "m"},
    {"freeboard", "m to the lowest rim"},
    {"frequency", "rad/s, undamped"},
    {"friction", "N m, N"},
    {"glide_angle", "degrees below the horizon"},
    {"glide_ratio", "along for each down"},
    {"height", "m"},
    {"height_of_mass", "m"},
    {"incidence", "degrees"},
    {"inertia", "m^2"},
    {"leaves_at", "laminar, turbulent; share of the length from the front, of both ways"},
    {"margin_over_chord", "of the largest wing, or the length"},
    {"neutral_point", "m"},
    {"origin", "m in the mesh's frame"},
    {"period", "s"},
    {"pressure", "N m, N"},
    {"rates", "1/s, of motions that do not swing; positive: they grow"},
    {"rim", "m round"},
    {"resistance", "m^3, m^2; m^2, m, per unit viscosity, rotation first"},
    {"rotation_resistance", "m^3"},
    {"seconds", "s"},
    {"size", "m"},
    {"smooth_share", "of the base; where it is 0, no boundary layer changes the drag"},
    {"span", "m"},
    {"speed", "m/s"},
    {"static_margin", "m behind the centre of mass"},
    {"smallest_angle", "rad"},
    {"thickness", "m"},
    {"total", "N m, N: torque about the origin of F, force"},
    {"translation_resistance", "m"},
    {"volume", "m^3"},
    {"waterplane_area", "m^2"}};

std::string numberText(const ordered_json& number, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, number.get<double>());
  return text;
}

/// Limit below which a number is shown as 0, relative to the largest one of its unit: rounding.
constexpr double kRounding = 1e-9;

/// A value on one line; of long lists the length. Numbers up to `rounding` become 0, and those of a
/// list that are rounding beside its largest.
std::string plainValue(const ordered_json& value, double rounding) {
  constexpr std::size_t kMostShown = 8;
  if (value.is_string()) return plainLine(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float())
    return std::abs(value.get<double>()) <= rounding ? "0" : numberText(value, "%.9g");
  if (!value.is_array()) return value.dump();
  if (value.size() > kMostShown) return std::to_string(value.size());
  for (const ordered_json& item : value)
    rounding = std::max(rounding, kRounding * std::abs(item.get<double>()));
  std::string text;
  for (const ordered_json& item : value)
    text += (text.empty() ? "" : ", ") + plainValue(item, rounding);
  return text;
}

/// The rows of a symmetric matrix: of 3x3 with one unit, or of 6x6, whose first three rows and
/// columns each have the unit of the others times a length.
std::string matrixText(const ordered_json& rows, const std::string& indent, double size) {
  const double lever = rows.size() == 6 ? size : 1;
  double largest = 0;
  for (std::size_t i = rows.size() - 3; i < rows.size(); ++i)
    largest = std::max(largest, std::abs(rows[i][i].get<double>()));
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += indent;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const double rounding = kRounding * largest * (i < 3 ? lever : 1) * (j < 3 ? lever : 1);
      const bool is_zero = std::abs(rows[i][j].get<double>()) <= rounding;
      text += numberText(is_zero ? ordered_json(0) : rows[i][j], " %14.6e");
    }
    text += "\n";
  }
  return text;
}

/// The largest extent in facts about a body, 0 without.
double sizeIn(const ordered_json& facts) {
  double size = 0;
  if (facts.contains("size"))
    for (const ordered_json& extent : facts["size"]) size = std::max(size, extent.get<double>());
  return size;
}

/// A row for each fact with a value, the parts of a fact indented; `size` of the body that they are
/// parts of [m], 0 if there is none.
std::string rowsText(const ordered_json& facts, const std::string& indent, double size) {
  constexpr std::size_t kWidth = 18;
  const std::string inside = indent + "  ";
  size = std::max(size, sizeIn(facts));
  std::string text;
  for (const auto& [key, value] : facts.items()) {
    if (value.empty() || (value.is_string() && value.get_ref<const std::string&>().empty()))
      continue;
    std::string title = indent + key;
    std::replace(title.begin(), title.end(), '_', ' ');
    const std::string label = title + std::string(kWidth - std::min(kWidth - 1, title.size()), ' ');
    const auto found = kUnits.find(key);
    const std::string unit = found == kUnits.end() ? "\n" : std::string(" ") + found->second + "\n";
    const bool is_length = unit.compare(0, 2, " m") == 0 && unit[2] != '^';
    const double rounding = is_length ? kRounding * size : 0;
    if (!value.is_structured() || (value.is_array() && value.front().is_number())) {
      text += label + plainValue(value, rounding) + unit;
    } else if (value.is_array() && value.front().is_array()) {
      text += label + unit + matrixText(value, inside, size);
    } else {
      for (const ordered_json& part : value.is_object() ? ordered_json::array({value}) : value)
        text += part.is_object() ? title + "\n" + rowsText(part, inside, size)
                                 : label + plainValue(part, rounding) + unit;
    }
  }
  return text;
}

ordered_json massJson(const MassDistribution& mass) {
  return {{"centre", vectorJson(mass.centre)}, {"inertia", matrixJson(mass.inertia)}};
}

ordered_json levelsJson(const std::vector<FormLevel>& levels) {
  ordered_json list = ordered_json::array();
  for (const FormLevel& level : levels)
    list.push_back({{"faces", level.faces.size()}, {"p99_error", level.p99_error}});
  return list;
}

ordered_json wingsJson(const FluidBody& body) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < body.wings.size(); ++i) {
    const Wing& wing = body.wings[i];
    list.push_back({{"name", wing.name},
                    {"span", wing.span},
                    {"chord", wing.chord},
                    {"thickness", wing.thickness},
                    {"aspect", wing.aspect},
                    {"body_lift", wing.body_lift},
                    {"joined", wing.is_joined},
                    {"nose", wing.nose},
                    {"camber", wing.camber},
                    {"share", body.form.wing_shares[i]},
                    {"facing", vectorJson(wing.facing)},
                    {"span_axis", vectorJson(wing.span_axis)},
                    {"centre", vectorJson(wing.centre)}});
  }
  return list;
}

bool isSheet(const FluidBody& body) { return body.volume == 0; }

/// What the body has in a fluid with viscosity; of a sphere in closed form.
ViscousForm viscousFormOf(const FluidBody& body) {
  if (body.sphere_radius == 0) return body.viscous;
  ViscousForm form;
  form.resistance = shiftOrigin(Matrix6(sphereResistance(body.sphere_radius).asDiagonal()),
                                -body.centre_of_volume);
  form.centre_of_reaction = body.centre_of_volume;
  form.separation = sphereSeparation();
  return form;
}

/// Shares of the base whose wake the layers shrink, by axis.
Vector3 sharesOf(const FluidBody& body) {
  return body.sphere_radius > 0 ? Vector3(1, 1, 1) : smoothShares(body, body.form.shape);
}

/// Facts of axis j of the separation: resistances, and where the drag falls if it does. R about the
/// centre of reaction. `share`: smooth part of the base, by the law [1].
ordered_json axisJson(const ViscousForm& form, const Matrix6& R, double share, int j) {
  const Separation& separation = form.separation;
  const Vector3 q = separation.axes.col(j);
  ordered_json facts{{"axis", vectorJson(q)},
                     {"translation_resistance", q.dot(R.bottomRightCorner<3, 3>() * q)},
                     {"rotation_resistance", q.dot(R.topLeftCorner<3, 3>() * q)},
                     {"smooth_share", share}};
  if (share == 0) return facts;
  // Where Re_theta is 205, half of the layers are turbulent when they leave a smooth wall.
  constexpr double kTransition = 205;
  for (std::size_t way = 2 * static_cast<std::size_t>(j), side = 0; side < 2; ++side) {
    const double N = separation.ways[way + side].thickness;
    facts["layer_thickness"].push_back(N);
    facts["drag_falls_at"].push_back(N > 0 ? kTransition * kTransition / (N * N) : 0);
  }
  return facts;
}

ordered_json viscousJson(const FluidBody& body, const ViscousForm& form) {
  const Vector3 shares = sharesOf(body);
  ordered_json axes = ordered_json::array();
  const Matrix6 R = shiftOrigin(form.resistance, form.centre_of_reaction);
  for (int j = 0; j < 3; ++j) axes.push_back(axisJson(form, R, shares[j], j));
  return {{"resistance", matrixJson(form.resistance)},
          {"centre_of_reaction", vectorJson(form.centre_of_reaction)},
          {"separation", axes}};
}

}  // namespace

std::string factsText(const ordered_json& facts, bool json) {
  return json ? facts.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n"
              : rowsText(facts, "", 0);
}

ordered_json holdsJson(const std::vector<Hold>& holds) {
  ordered_json list = ordered_json::array();
  for (const Hold& hold : holds) {
    ordered_json facts{{"name", hold.name}, {"volume", hold.volume}};
    for (const HoldOpening& opening : hold.openings) {
      const Rim rim = rimOf(opening);
      ordered_json own{{"rim", rim.length}, {"centre", vectorJson(rim.centre)}};
      if (opening.to >= 0) own["to"] = holds[static_cast<std::size_t>(opening.to)].name;
      facts["openings"].push_back(own);
    }
    list.push_back(facts);
  }
  return list;
}

ordered_json bodyFacts(const FluidBody& body) {
  ordered_json facts{{"name", body.name},
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
  if (!body.form_levels.empty()) facts["form_levels"] = levelsJson(body.form_levels);
  if (!body.holds.empty()) facts["holds"] = holdsJson(body.holds);
  if (!body.wings.empty()) facts["wings"] = wingsJson(body);
  if (!body.waterline.empty())
    facts["waterline_table"] = {{"subdivisions", body.waterline.subdivisions},
                                {"immersions", body.waterline.immersions.size()}};
  if (const ViscousForm form = viscousFormOf(body); form.isKnown())
    facts["viscous_flow"] = viscousJson(body, form);
  return facts;
}

}  // namespace ambient
