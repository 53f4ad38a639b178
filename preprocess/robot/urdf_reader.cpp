#include "preprocess/robot/urdf_reader.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <mutex>
#include <set>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/robot/urdf_text.h"
#include "preprocess/shape/json_text.h"

namespace ambient {
namespace {

/// Catches what urdfdom says while it lives. urdfdom has one handler for all threads.
class UrdfdomMessages : public console_bridge::OutputHandler {
 public:
  UrdfdomMessages() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~UrdfdomMessages() override { console_bridge::restorePreviousOutputHandler(); }
  UrdfdomMessages(const UrdfdomMessages&) = delete;
  UrdfdomMessages& operator=(const UrdfdomMessages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR)
      text_ += (text_.empty() ? "" : "; ") + plainLine(text);
  }
  const std::string& text() const { return text_; }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  std::string text_;
};

/// A model of urdfdom. Clears the links' lists of children when it is destroyed: links in a loop
/// hold each other and would never be freed.
struct UrdfModel {
  urdf::ModelInterfaceSharedPtr model;

  UrdfModel() = default;
  UrdfModel(const UrdfModel&) = delete;
  UrdfModel& operator=(const UrdfModel&) = delete;
  ~UrdfModel() {
    if (!model) return;
    for (const auto& [name, link] : model->links_) link->child_links.clear();
  }
};

/// Parses a URDF text with urdfdom into `parsed`. `source` begins messages.
/// @throws std::runtime_error
void parseChecked(const std::string& urdf, const std::string& source, UrdfModel& parsed) {
  const UrdfdomMessages messages;
  try {
    // urdfdom reports parts that it cannot read as messages, and may leave them out.
    parsed.model = urdf::parseURDF(urdf);
    if (parsed.model && messages.text().empty()) return;
  } catch (const std::exception& error) {
    raiseInputError(source, error.what());
  }
  raiseInputError(source, messages.text().empty() ? "is not a robot" : messages.text());
}

Vector3 toVector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

RigidPose toPose(const urdf::Pose& from) {
  const urdf::Rotation& q = from.rotation;
  RigidPose pose = RigidPose::Identity();
  pose.linear() = Quaternion(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  pose.translation() = toVector(from.position);
  return pose;
}

/// Reads the links and joints of one file, the parents first.
class ModelReader {
 public:
  ModelReader(const UrdfText& text, std::filesystem::path file, const PackageFolders& packages)
      : text_(text), file_(std::move(file)), packages_(packages) {
    model_.source = file_.string();
  }

  RobotModel read(const urdf::ModelInterface& from) {
    model_.name = from.getName();
    checkTree(from);
    addLink(*from.getRoot(), -1);
    if (model_.links.size() != from.links_.size()) refuse("the joints close a loop");
    return std::move(model_);
  }

 private:
  [[noreturn]] void refuse(const std::string& sentence) const {
    raiseInputError(model_.source, sentence);
  }

  void require(bool holds, const std::string& element, const std::string& key, double value,
               const char* limit) const {
    if (!holds)
      raiseInputError(model_.source, element, ": ", key, " is ", value, "; must be ", limit);
  }

  /// Checks that urdfdom does not make.
  void checkTree(const urdf::ModelInterface& from) const {
    constexpr std::size_t kMostLinks = 2000;  // the tree is read by recursion
    if (from.links_.size() > kMostLinks)
      refuse("it has " + std::to_string(from.links_.size()) + " links; must be at most " +
             std::to_string(kMostLinks));
    std::set<std::string> children;
    for (const auto& [name, joint] : from.joints_)
      if (!children.insert(joint->child_link_name).second)
        refuse("link \"" + joint->child_link_name + "\" is the child of two joints, one is \"" +
               name + "\"; must be of one");
    for (const auto& [link, attributes] : text_.ambient)
      if (from.links_.count(link) == 0) refuse("<ambient> stands in a link without a name");
  }

  void addLink(const urdf::Link& from, int parent) {
    const int index = static_cast<int>(model_.links.size());
    LinkModel link;
    link.name = from.name;
    link.parent = parent;
    if (from.parent_joint) link.joint = readJoint(*from.parent_joint);
    if (from.inertial) readInertia(*from.inertial, link);
    for (std::size_t i = 0; i < from.collision_array.size(); ++i)
      link.collisions.push_back(readCollision(*from.collision_array[i], from.name, i));
    link.fluid = readFluid(from.name);
    model_.links.push_back(std::move(link));
    for (const urdf::LinkSharedPtr& child : from.child_links) addLink(*child, index);
  }

  void readInertia(const urdf::Inertial& from, LinkModel& link) {
    const std::string element = "link \"" + link.name + "\": <inertial>";
    require(from.mass >= 0 && std::isfinite(from.mass), element, "mass", from.mass, ">= 0");
    const RigidPose pose = toPose(from.origin);
    Matrix3 inertia;
    inertia << from.ixx, from.ixy, from.ixz, from.ixy, from.iyy, from.iyz, from.ixz, from.iyz,
        from.izz;
    require(inertia.allFinite(), element, "inertia", inertia.sum(), "finite");
    link.mass = from.mass;
    link.centre_of_mass = pose.translation();
    link.inertia = pose.linear() * inertia * pose.linear().transpose();
  }

  JointModel readJoint(const urdf::Joint& from) const {
    JointModel joint;
    joint.name = from.name;
    const std::string element = "joint \"" + joint.name + "\"";
    joint.kind = kindOf(from);
    joint.origin = toPose(from.parent_to_joint_origin_transform);
    if (joint.hasAxis()) {
      const double length = toVector(from.axis).norm();
      require(length > 0 && std::isfinite(length), element, "the length of its axis", length,
              "> 0");
      joint.axis = toVector(from.axis) / length;
    }
    if (from.limits && joint.isAxial()) readLimits(from, joint);
    if (from.dynamics) {
      joint.damping = from.dynamics->damping;
      joint.friction = from.dynamics->friction;
      require(joint.damping >= 0, element, "damping", joint.damping, ">= 0");
      require(joint.friction >= 0, element, "friction", joint.friction, ">= 0");
    }
    if (from.mimic)
      joint.mimic = {from.mimic->joint_name, from.mimic->multiplier, from.mimic->offset};
    return joint;
  }

  UrdfJointKind kindOf(const urdf::Joint& from) const {
    switch (from.type) {
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        return UrdfJointKind::kRevolute;
      case urdf::Joint::PRISMATIC:
        return UrdfJointKind::kPrismatic;
      case urdf::Joint::PLANAR:
        return UrdfJointKind::kPlanar;
      case urdf::Joint::FLOATING:
        return UrdfJointKind::kFloating;
      case urdf::Joint::FIXED:
        return UrdfJointKind::kFixed;
      default:
        refuse("joint \"" + from.name + "\": its type is not known");
    }
  }

  void readLimits(const urdf::Joint& from, JointModel& joint) const {
    const urdf::JointLimits& limits = *from.limits;
    const std::string element = "joint \"" + joint.name + "\": <limit>";
    require(limits.effort >= 0, element, "effort", limits.effort, ">= 0");
    require(limits.velocity >= 0, element, "velocity", limits.velocity, ">= 0");
    joint.effort = limits.effort;
    joint.velocity = limits.velocity;
    if (from.type == urdf::Joint::CONTINUOUS) return;
    require(limits.lower <= limits.upper, element, "lower", limits.lower, "at most upper");
    joint.lower = limits.lower;
    joint.upper = limits.upper;
  }

  PlacedShape readCollision(const urdf::Collision& from, const std::string& link,
                            std::size_t number) const {
    const std::string element = "link \"" + link + "\": <collision> " + std::to_string(number + 1);
    PlacedShape part;
    part.pose = toPose(from.origin);
    part.name = model_.source + ": " + element;
    if (const std::optional<OwnGeometry>& own = text_.geometry.at(link).at(number)) {
      if (own->kind == "capsule")
        part.shape = Capsule{own->sizes.x(), own->sizes.y()};
      else
        part.shape = Ellipsoid{own->sizes};
      return part;
    }
    if (!from.geometry) raiseInputError(part.name, "has no geometry");
    readGeometry(*from.geometry, element, part);
    return part;
  }

  void readGeometry(const urdf::Geometry& from, const std::string& element,
                    PlacedShape& part) const {
    if (from.type == urdf::Geometry::SPHERE) {
      part.shape = Sphere{length(static_cast<const urdf::Sphere&>(from).radius, element)};
    } else if (from.type == urdf::Geometry::BOX) {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(from).dim;
      part.shape = Box{Eigen::Vector3d(length(size.x, element), length(size.y, element),
                                       length(size.z, element)) /
                       2};
    } else if (from.type == urdf::Geometry::CYLINDER) {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(from);
      part.shape = Cylinder{length(cylinder.radius, element), length(cylinder.length, element)};
    } else {
      const auto& mesh = static_cast<const urdf::Mesh&>(from);
      const Vector3 scale = toVector(mesh.scale);
      require(scale.allFinite() && scale.cwiseAbs().minCoeff() > 0, element,
              "the least scale of its mesh", scale.cwiseAbs().minCoeff(), "not 0");
      part.shape = MeshFile{resolveReference(mesh.filename, file_, packages_, part.name), 1,
                            MeshStandIn::kHull, 0, scale};
    }
  }

  double length(double value, const std::string& element) const {
    require(value > 0 && std::isfinite(value), element, "a length", value, "> 0");
    return value;
  }

  std::optional<LinkFluid> readFluid(const std::string& link) const {
    const auto found = text_.ambient.find(link);
    if (found == text_.ambient.end()) return std::nullopt;
    const std::string element = "link \"" + link + "\": <ambient>";
    LinkFluid fluid;
    for (const auto& [key, value] : found->second) {
      if (key == "medium") {
        if (value != "water" && value != "air" && value != "none")
          refuse(element + " medium is \"" + value + "\"; must be water, air or none");
        fluid.medium = value;
      } else if (key == "law") {
        fluid.law = lawOf(value, element);
      } else {
        fluid.fluid_body =
            resolveReference(value, file_, packages_, model_.source + ": " + element);
      }
    }
    return fluid;
  }

  PressureLaw lawOf(const std::string& word, const std::string& element) const {
    if (const auto law = valueOf(kPressureLawNames, word)) return *law;
    refuse(element + " law is \"" + word + "\"; must be published or form");
  }

  const UrdfText& text_;
  std::filesystem::path file_;
  const PackageFolders& packages_;
  RobotModel model_;
};

}  // namespace

RobotModel readUrdf(const std::filesystem::path& file, const PackageFolders& packages) {
  requireRegularFile(file, "URDF");
  return parseUrdf(readBytes(file), file, packages);
}

RobotModel parseUrdf(const std::string& text, const std::filesystem::path& file,
                     const PackageFolders& packages) {
  const UrdfText divided = divideUrdf(text, file.string());
  UrdfModel parsed;
  parseChecked(divided.urdf, file.string(), parsed);
  return ModelReader(divided, file, packages).read(*parsed.model);
}

}  // namespace ambient
