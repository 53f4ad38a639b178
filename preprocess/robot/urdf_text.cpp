#include "preprocess/robot/urdf_text.h"

#include <tinyxml.h>

#include <cmath>
#include <set>
#include <sstream>

#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

/// TinyXML reads elements in elements by recursion.
constexpr int kDeepest = 200;

void checkDepth(const std::string& text, const std::string& source) {
  int depth = 0;
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i + 1)) {
    const char next = i + 1 < text.size() ? text[i + 1] : '>';
    if (next == '!' || next == '?') continue;
    const std::size_t end = text.find('>', i);
    const bool closed = end != std::string::npos && text[end - 1] == '/';
    if (next == '/')
      --depth;
    else if (!closed)
      ++depth;
    if (depth > kDeepest)
      raiseInputError(source, "elements are nested more than ", kDeepest, " deep");
  }
}

std::string attributeOf(const TiXmlElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? value : "";
}

std::string placeOf(const TiXmlElement& element, const std::string& link) {
  return "line " + std::to_string(element.Row()) + ", link \"" + link + "\": <" +
         element.ValueStr() + ">";
}

/// Reads `count` positive numbers from a text. @throws std::runtime_error
Vector3 readSizes(const std::string& text, int count, const std::string& place) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  Vector3 sizes = Vector3::Zero();
  std::string rest;
  for (int i = 0; i < count; ++i) stream >> sizes[i];
  if (!stream || stream >> rest || !(sizes.head(count).minCoeff() > 0) || !sizes.allFinite())
    raiseInputError(place, "is \"", text, "\"; must be ", count, count > 1 ? " numbers" : " number",
                    " > 0");
  return sizes;
}

/// Returns the shape of our own that a <geometry> holds and puts a sphere in its place, which
/// urdfdom can read; none if it holds another shape.
std::optional<OwnGeometry> takeOwnGeometry(TiXmlElement& geometry, const std::string& link,
                                           const std::string& source) {
  TiXmlElement* shape = geometry.FirstChildElement();
  if (!shape) return std::nullopt;
  OwnGeometry own{shape->ValueStr(), {0, 0, 0}};
  const auto sizes = [&](const char* name, int count) {
    return readSizes(attributeOf(*shape, name), count,
                     source + ": " + placeOf(*shape, link) + " " + name);
  };
  if (own.kind == "capsule")
    own.sizes = {sizes("radius", 1).x(), sizes("length", 1).x(), 0};
  else if (own.kind == "ellipsoid")
    own.sizes = sizes("semi_axes", 3);
  else
    return std::nullopt;
  TiXmlElement sphere("sphere");
  sphere.SetAttribute("radius", "1");
  geometry.ReplaceChild(shape, sphere);
  return own;
}

AmbientAttributes readAmbient(const TiXmlElement& element, const std::string& link,
                              const std::string& source) {
  static const std::set<std::string> kKnown{"medium", "fluid_body", "law"};
  AmbientAttributes attributes;
  for (auto* a = element.FirstAttribute(); a; a = a->Next()) {
    if (kKnown.count(a->Name()) == 0)
      raiseInputError(source, placeOf(element, link), " has the attribute \"", a->Name(),
                      "\"; known are: fluid_body, law, medium");
    attributes[a->Name()] = a->Value();
  }
  return attributes;
}

/// Removes the children that have none of these names.
void keepOnly(TiXmlElement& parent, const std::set<std::string>& names) {
  for (TiXmlNode* child = parent.FirstChild(); child;) {
    TiXmlNode* next = child->NextSibling();
    if (!child->ToElement() || names.count(child->ValueStr()) == 0) parent.RemoveChild(child);
    child = next;
  }
}

void divideLink(TiXmlElement& element, const std::string& source, UrdfText& divided) {
  const std::string name = attributeOf(element, "name");
  for (auto* own = element.FirstChildElement("ambient"); own;
       own = own->NextSiblingElement("ambient"))
    if (!divided.ambient.emplace(name, readAmbient(*own, name, source)).second)
      raiseInputError(source, placeOf(*own, name), " is there twice");
  for (auto* part = element.FirstChildElement("collision"); part;
       part = part->NextSiblingElement("collision")) {
    TiXmlElement* geometry = part->FirstChildElement("geometry");
    divided.geometry[name].push_back(geometry ? takeOwnGeometry(*geometry, name, source)
                                              : std::nullopt);
  }
  keepOnly(element, {"inertial", "collision"});
}

}  // namespace

UrdfText divideUrdf(const std::string& text, const std::string& source) {
  if (text.find('\0') != std::string::npos) raiseInputError(source, "is not XML: it holds a zero");
  checkDepth(text, source);
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error())
    raiseInputError(source, "line ", document.ErrorRow(), ": ", document.ErrorDesc());
  TiXmlElement* robot = document.FirstChildElement("robot");
  if (!robot) raiseInputError(source, "has no element <robot>");
  UrdfText divided;
  keepOnly(*robot, {"link", "joint"});
  for (auto* link = robot->FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
    divideLink(*link, source, divided);
  TiXmlPrinter printer;
  document.Accept(&printer);
  divided.urdf = printer.Str();
  return divided;
}

}  // namespace ambient
