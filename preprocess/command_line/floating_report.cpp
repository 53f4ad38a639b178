#include "preprocess/command_line/floating_report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bullet_ambient/fluid_body/displaced_mass.h"
#include "bullet_ambient/force/medium/medium.h"
#include "preprocess/command_line/json_numbers.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

constexpr int kMostAlike = 48;  // by the symmetry of a box; more: it turns freely

template <class... Numbers>
std::string line(const char* format, Numbers... numbers) {
  char text[200];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

// Components of a unit vector to four decimals: what is below is noise of the search.
std::string directionText(const Vector3& v) {
  const auto rounded = [](double x) { return std::round(1e4 * x) / 1e4 + 0.0; };
  return line("%.4g, %.4g, %.4g", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

// Period of a mode of body and added mass, without damping by waves; "none" where nothing turns the
// body back.
std::string modeText(const SmallOscillation& mode) {
  const bool has_period = std::isfinite(mode.period);
  if (!has_period && mode.turn.isZero(0)) return "";  // nothing to tell
  const bool is_heave = mode.is_heave && has_period;
  return "    period          " +
         (has_period ? line("%.4g s, ", mode.period) : std::string("none, ")) +
         (is_heave ? "heave" : "turn about " + directionText(mode.turn)) + "\n";
}

std::string attitudeText(const FloatingAttitude& attitude) {
  std::string text = "  up is " + directionText(attitude.up);
  if (attitude.up.z() < -attitude.up.head<2>().norm()) text += ", z downwards";
  if (attitude.alike > kMostAlike) {
    text += ", or turned freely";
  } else if (attitude.alike > 1) {
    text += line(", and %d alike", attitude.alike - 1);
  }
  text += line("; reached from %.0f %% of all attitudes\n", 100 * attitude.share);
  text += line("    draught         %.5g m\n", attitude.draught);
  text += line("    centre of mass  %.5g m above the water\n", attitude.height_of_mass);
  text += line("    waterplane      %.5g m^2\n", attitude.wet.waterplane.area);
  for (const Metacentre& metacentre : attitude.metacentres)
    text += line("    GM              %.4g m, about ", metacentre.height) +
            directionText(metacentre.axis) + "\n";
  for (const SmallOscillation& mode : attitude.modes) text += modeText(mode);
  return text;
}

ordered_json modeJson(const SmallOscillation& mode) {
  ordered_json json{{"heave", mode.is_heave}, {"turn", vectorJson(mode.turn)}};
  json["period"] = std::isfinite(mode.period) ? ordered_json(mode.period) : ordered_json();
  return json;
}

ordered_json attitudeJson(const FloatingAttitude& attitude) {
  ordered_json json{{"up", vectorJson(attitude.up)},
                    {"alike", attitude.alike},
                    {"share", attitude.share},
                    {"draught", attitude.draught},
                    {"height_of_mass", attitude.height_of_mass},
                    {"waterplane_area", attitude.wet.waterplane.area},
                    {"metacentres", ordered_json::array()},
                    {"modes", ordered_json::array()}};
  for (const Metacentre& metacentre : attitude.metacentres)
    json["metacentres"].push_back(
        {{"height", metacentre.height}, {"axis", vectorJson(metacentre.axis)}});
  for (const SmallOscillation& mode : attitude.modes) json["modes"].push_back(modeJson(mode));
  return json;
}

}  // namespace

std::string floatingTable(const FloatingBody& body) {
  std::string text = line("with %.6g kg on water of %.6g kg/m^3\n", body.mass, body.density);
  const double air_mass = air().density * body.shape->volume;
  if (DisplacedMass{body.mass, air_mass}.isMuchLighter())
    text += line("  it is lighter than the %.6g kg of air in its place: is its mesh in metres?\n",
                 air_mass);
  const auto attitudes = findFloatingAttitudes(body);
  if (attitudes.empty())
    return text + line("  it sinks: it displaces %.6g kg\n", body.density * body.shape->volume);
  for (const FloatingAttitude& attitude : attitudes) text += attitudeText(attitude);
  return text;
}

ordered_json floatingJson(const FloatingBody& body) {
  ordered_json list = ordered_json::array();
  for (const FloatingAttitude& attitude : findFloatingAttitudes(body))
    list.push_back(attitudeJson(attitude));
  return list;
}

}  // namespace ambient
