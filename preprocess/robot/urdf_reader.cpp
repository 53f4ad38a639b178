#if defined(AMBIENT_READS_URDF)
#include <tinyxml2.h>
#endif

#include <array>
#include <cmath>
#include <locale>
#include <set>
#include <sstream>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/plain_text.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/robot/robot_model.h"
#include "preprocess/shape/json_schema.h"

namespace ambient {

#if defined(AMBIENT_READS_URDF)

namespace {

using tinyxml2::XMLElement;

constexpr std::array<std::pair<UrdfJointKind, const char*>, 6> kJointKindNames{
    {{UrdfJointKind::kFixed, "fixed"},
     {UrdfJointKind::kRevolute, "revolute"},
     {UrdfJointKind::kRevolute, "continuous"},
     {UrdfJointKind::kPrismatic, "prismatic"},
     {UrdfJointKind::kPlanar, "planar"},
     {UrdfJointKind::kFloating, "floating"}}};

/// Rotation by roll, pitch and yaw about the fixed axes x, y and z in turn [rad].
Quaternion rotationFromAngles(const Vector3& angles) {
  const Vector3 half = angles / 2;
  Vector3 c, s;
  for (int i = 0; i < 3; ++i) {
    c[i] = portable::cos(half[i]);
    s[i] = portable::sin(half[i]);
  }
  return Quaternion(
             c[0] * c[1] * c[2] + s[0] * s[1] * s[2], s[0] * c[1] * c[2] - c[0] * s[1] * s[2],
             c[0] * s[1] * c[2] + s[0] * c[1] * s[2], c[0] * c[1] * s[2] - s[0] * s[1] * c[2])
      .normalized();
}

/// An element and the link or joint that it belongs to, for messages.
struct Part {
  const XMLElement* element;
  std::string owner;

  std::string name() const { return "<" + std::string(element->Name()) + ">"; }
  bool is(const char* kind) const { return std::string(element->Name()) == kind; }
};

/// Reads the links and joints of one document, the parents first.
class UrdfReader {
 public:
  UrdfReader(std::filesystem::path file, const PackageFolders& packages)
      : file_(std::move(file)), packages_(packages) {
    model_.source = file_.string();
  }

  RobotModel read(const XMLElement& robot) {
    model_.name = attribute({&robot, ""}, "name");
    readNames(robot);
    addLink(root(), -1);
    if (model_.links.size() != links_.size()) refuse("the joints close a loop");
    return std::move(model_);
  }

 private:
  template <class... Words>
  [[noreturn]] void refuse(const Words&... words) const {
    raiseInputError(model_.source, words...);
  }
  template <class... Words>
  [[noreturn]] void refusePart(const Part& part, const Words&... words) const {
    refuse("line ", part.element->GetLineNum(), part.owner.empty() ? "" : ", ", part.owner, ": ",
           part.name(), " ", words...);
  }
  void require(bool holds, const std::string& element, const std::string& key, double value,
               const char* limit) const {
    if (!holds) refuse(element, ": ", key, " is ", value, "; must be ", limit);
  }

  std::string attribute(const Part& part, const char* name) const {
    if (const char* value = part.element->Attribute(name)) return value;
    refusePart(part, "has no ", name);
  }

  /// Reads `count` numbers and nothing else from an attribute.
  Vector3 numbers(const Part& part, const char* name, int count) const {
    const std::string text = attribute(part, name);
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    Vector3 values = Vector3::Zero();
    for (int i = 0; i < count; ++i) stream >> values[i];
    std::string rest;
    if (!stream || stream >> rest || !values.allFinite())
      refusePart(part, name, " is \"", text, "\"; must be ", count,
                 count > 1 ? " numbers" : " number");
    return values;
  }
  double number(const Part& part, const char* name) const { return numbers(part, name, 1).x(); }
  double numberOr(const Part& part, const char* name, double absent) const {
    return part.element->Attribute(name) ? number(part, name) : absent;
  }
  /// Reads lengths, sizes or radii: all must be above 0.
  Vector3 sizes(const Part& part, const char* name, int count) const {
    const Vector3 values = numbers(part, name, count);
    const double least = values.head(count).minCoeff();
    if (!(least > 0)) refusePart(part, name, " is ", least, "; must be > 0");
    return values;
  }

  static Part childOf(const Part& part, const char* name) {
    return {part.element->FirstChildElement(name), part.owner};
  }
  Part requiredChild(const Part& part, const char* name) const {
    Part child = childOf(part, name);
    if (!child.element) refusePart(part, "has no <", name, ">");
    return child;
  }

  /// Pose of <origin xyz rpy/> in an element; the identity without one.
  RigidPose originOf(const Part& part) const {
    RigidPose pose = RigidPose::Identity();
    const Part origin = childOf(part, "origin");
    if (!origin.element) return pose;
    if (origin.element->Attribute("xyz")) pose.translation() = numbers(origin, "xyz", 3);
    if (origin.element->Attribute("rpy"))
      pose.linear() = rotationFromAngles(numbers(origin, "rpy", 3)).toRotationMatrix();
    return pose;
  }

  /// Lists links, and joints by their parents.
  void readNames(const XMLElement& robot) {
    constexpr std::size_t kMostLinks = 2000;  // the tree is read by recursion
    for (auto* link = robot.FirstChildElement("link"); link;
         link = link->NextSiblingElement("link")) {
      const std::string name = attribute({link, ""}, "name");
      if (!links_.emplace(name, Part{link, "link \"" + name + "\""}).second)
        refuse("link \"", name, "\" is there twice");
    }
    if (links_.empty()) refuse("it has no links");
    if (links_.size() > kMostLinks)
      refuse("it has ", links_.size(), " links; must be at most ", kMostLinks);
    std::map<std::string, Part> joints;
    for (auto* joint = robot.FirstChildElement("joint"); joint;
         joint = joint->NextSiblingElement("joint")) {
      const std::string name = attribute({joint, ""}, "name");
      if (!joints.emplace(name, Part{joint, "joint \"" + name + "\""}).second)
        refuse("joint \"", name, "\" is there twice");
    }
    for (const auto& [name, joint] : joints) readEnds(name, joint);
  }

  void readEnds(const std::string& name, const Part& joint) {
    const auto end = [&](const char* kind) {
      const std::string link = attribute(requiredChild(joint, kind), "link");
      if (links_.count(link) == 0)
        refuse(joint.owner, ": its ", kind, " \"", link, "\" is no link");
      return link;
    };
    const std::string parent = end("parent"), child = end("child");
    if (!children_.insert(child).second)
      refuse("link \"", child, "\" is the child of two joints, one is \"", name,
             "\"; must be of one");
    joints_of_[parent].push_back({joint, child});
  }

  /// The link that is no joint's child.
  std::string root() const {
    std::string found;
    for (const auto& [name, link] : links_) {
      if (children_.count(name) > 0) continue;
      if (!found.empty())
        refuse("links \"", found, "\" and \"", name, "\" are the child of no joint; must be one");
      found = name;
    }
    if (found.empty()) refuse("the joints close a loop");
    return found;
  }

  void addLink(const std::string& name, int parent, JointModel joint = {}) {
    const int index = static_cast<int>(model_.links.size());
    const Part& from = links_.at(name);
    LinkModel link;
    link.name = name;
    link.parent = parent;
    link.joint = std::move(joint);
    if (const Part inertial = childOf(from, "inertial"); inertial.element)
      readInertia(inertial, link);
    for (auto* part = from.element->FirstChildElement("collision"); part;
         part = part->NextSiblingElement("collision"))
      link.collisions.push_back(readCollision({part, from.owner}, link.collisions.size() + 1));
    if (const Part fluid = childOf(from, "ambient"); fluid.element) link.fluid = readFluid(fluid);
    model_.links.push_back(std::move(link));
    for (const auto& [below, child] : joints_of_[name]) addLink(child, index, readJoint(below));
  }

  void readInertia(const Part& from, LinkModel& link) const {
    const RigidPose pose = originOf(from);
    link.mass = number(requiredChild(from, "mass"), "value");
    require(link.mass >= 0, from.owner + ": <inertial>", "mass", link.mass, ">= 0");
    const Part moments = requiredChild(from, "inertia");
    Matrix3 inertia;
    struct Entry {
      const char* key;
      int i, j;
    };
    for (const auto& [key, i, j] : {Entry{"ixx", 0, 0}, Entry{"ixy", 0, 1}, Entry{"ixz", 0, 2},
                                    Entry{"iyy", 1, 1}, Entry{"iyz", 1, 2}, Entry{"izz", 2, 2}})
      inertia(i, j) = inertia(j, i) = number(moments, key);
    link.centre_of_mass = pose.translation();
    link.inertia = pose.linear() * inertia * pose.linear().transpose();
  }

  JointModel readJoint(const Part& from) const {
    JointModel joint;
    joint.name = attribute(from, "name");
    const std::string type = attribute(from, "type");
    const auto kind = valueOf(kJointKindNames, type);
    if (!kind) refuse(from.owner, ": its type \"", type, "\" is not known");
    joint.kind = *kind;
    joint.origin = originOf(from);
    if (const Part axis = childOf(from, "axis"); axis.element && joint.hasAxis()) {
      const Vector3 along = numbers(axis, "xyz", 3);
      require(along.norm() > 0, from.owner, "the length of its axis", along.norm(), "> 0");
      joint.axis = along / along.norm();
    }
    if (joint.isAxial()) readLimits(from, type == "continuous", joint);
    if (const Part dynamics = childOf(from, "dynamics"); dynamics.element) {
      joint.damping = numberOr(dynamics, "damping", 0);
      joint.friction = numberOr(dynamics, "friction", 0);
      require(joint.damping >= 0, from.owner, "damping", joint.damping, ">= 0");
      require(joint.friction >= 0, from.owner, "friction", joint.friction, ">= 0");
    }
    if (const Part mimic = childOf(from, "mimic"); mimic.element)
      joint.mimic = {attribute(mimic, "joint"), numberOr(mimic, "multiplier", 1),
                     numberOr(mimic, "offset", 0)};
    return joint;
  }

  /// Continuous joints need no limits, and have none of their position.
  void readLimits(const Part& from, bool is_continuous, JointModel& joint) const {
    const Part limit = childOf(from, "limit");
    if (!limit.element) {
      if (is_continuous) return;
      refusePart(from, "has no <limit>");
    }
    const std::string element = from.owner + ": <limit>";
    joint.effort = number(limit, "effort");
    joint.velocity = number(limit, "velocity");
    require(joint.effort >= 0, element, "effort", joint.effort, ">= 0");
    require(joint.velocity >= 0, element, "velocity", joint.velocity, ">= 0");
    if (is_continuous) return;
    joint.lower = numberOr(limit, "lower", 0);
    joint.upper = numberOr(limit, "upper", 0);
    require(joint.lower <= joint.upper, element, "lower", joint.lower, "at most upper");
  }

  PlacedShape readCollision(const Part& from, std::size_t number) const {
    PlacedShape part;
    part.pose = originOf(from);
    part.name = model_.source + ": " + from.owner + ": <collision> " + std::to_string(number);
    const Part geometry = requiredChild(from, "geometry");
    const Part shape{geometry.element->FirstChildElement(), from.owner};
    if (!shape.element) raiseInputError(part.name, "has no geometry");
    part.shape = readShape(shape, part.name);
    return part;
  }

  Shape readShape(const Part& from, const std::string& name) const {
    const auto size = [&](const char* key) { return sizes(from, key, 1).x(); };
    if (from.is("sphere")) return Sphere{size("radius")};
    if (from.is("box")) return Box{sizes(from, "size", 3) / 2};
    if (from.is("cylinder")) return Cylinder{size("radius"), size("length")};
    if (from.is("capsule")) return Capsule{size("radius"), size("length")};
    if (from.is("ellipsoid")) return Ellipsoid{sizes(from, "semi_axes", 3)};
    if (!from.is("mesh")) refusePart(from, "is no shape that is known");
    const Vector3 scale =
        from.element->Attribute("scale") ? numbers(from, "scale", 3) : Vector3(1, 1, 1);
    if (!(scale.cwiseAbs().minCoeff() > 0)) refusePart(from, "has a scale of 0");
    return MeshFile{resolveReference(attribute(from, "filename"), file_, packages_, name), 1,
                    MeshStandIn::kHull, 0, scale};
  }

  LinkFluid readFluid(const Part& from) const {
    if (from.element->NextSiblingElement("ambient")) refusePart(from, "is there twice");
    if (const XMLElement* inner = from.element->FirstChildElement())
      refusePart(from, "holds <", inner->Name(), ">; it has attributes alone");
    const std::string element = from.owner + ": <ambient>";
    LinkFluid fluid;
    for (auto* a = from.element->FirstAttribute(); a; a = a->Next()) {
      const std::string key = a->Name(), value = a->Value();
      if (key == "medium") {
        if (value != "water" && value != "air" && value != "none")
          refuse(element, " medium is \"", value, "\"; must be water, air or none");
        fluid.medium = value;
      } else if (key == "law") {
        fluid.law = valueOf(kPressureLawNames, value);
        if (!fluid.law) refuse(element, " law is \"", value, "\"; must be published or form");
      } else if (key == "roughness") {
        fluid.roughness = number(from, "roughness");
        require(*fluid.roughness >= 0, element, "roughness", *fluid.roughness, ">= 0");
      } else if (key == "fluid_body") {
        fluid.fluid_body =
            resolveReference(value, file_, packages_, model_.source + ": " + element);
      } else {
        refusePart(from, "has the attribute \"", key,
                   "\"; known are: fluid_body, law, medium, roughness");
      }
    }
    return fluid;
  }

  struct Below {
    Part joint;
    std::string child;
  };

  std::filesystem::path file_;
  const PackageFolders& packages_;
  RobotModel model_;
  std::map<std::string, Part> links_;
  std::map<std::string, std::vector<Below>> joints_of_;  // by parent, in the order of their names
  std::set<std::string> children_;
};

}  // namespace

RobotModel readUrdf(const std::filesystem::path& file, const PackageFolders& packages) {
  requireRegularFile(file, "URDF");
  return parseUrdf(readBytes(file), file, packages);
}

RobotModel parseUrdf(const std::string& text, const std::filesystem::path& file,
                     const PackageFolders& packages) {
  const std::string source = file.string();
  if (text.find('\0') != std::string::npos) raiseInputError(source, "is not XML: it holds a zero");
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    raiseInputError(source, "line ", document.ErrorLineNum(),
                    ": is not XML: ", document.ErrorName());
  const XMLElement* robot = document.FirstChildElement("robot");
  if (!robot) raiseInputError(source, "has no element <robot>");
  return UrdfReader(file, packages).read(*robot);
}

#else

RobotModel readUrdf(const std::filesystem::path& file, const PackageFolders& packages) {
  return parseUrdf("", file, packages);
}

RobotModel parseUrdf(const std::string&, const std::filesystem::path& file, const PackageFolders&) {
  raiseInputError(file.string(),
                  "URDF files need tinyxml2 (Debian: libtinyxml2-dev), without which this "
                  "was built");
}

#endif

}  // namespace ambient
