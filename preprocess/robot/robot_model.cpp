#include "preprocess/robot/robot_model.h"

#include <algorithm>
#include <utility>

#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {

namespace {

/// Index of the first link that fits, or the complaint with all names.
template <class Fits, class Name>
int findLink(const RobotModel& model, const std::string& what, const Fits& fits,
             const Name& name_of) {
  std::string known;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (fits(model.links[i])) return static_cast<int>(i);
    const std::string name = name_of(model.links[i]);
    if (!name.empty()) known += (known.empty() ? "" : ", ") + name;
  }
  raiseInputError(model.source, what, " is not known; known are: ", known.empty() ? "none" : known);
}

void checkMoments(const RobotModel& model, const LinkModel& link) {
  const Vector3 moments = findPrincipalFrame(link.inertia).moments;
  if (!(moments.minCoeff() > 0))
    raiseInputError(model.source, "link \"", link.name, "\": its smallest moment of inertia is ",
                    moments.minCoeff(), " kg m^2; must be > 0 where a link moves");
}

void checkMovingLink(const RobotModel& model, const LinkModel& link) {
  if (!(link.mass > 0))
    raiseInputError(model.source, "link \"", link.name, "\": its mass is ", link.mass,
                    " kg; must be > 0 where a link moves",
                    link.parent < 0 ? "; a fixed base (fixed_base) needs none" : "");
  checkMoments(model, link);
}

void checkMimic(const RobotModel& model, const JointModel& joint) {
  if (!joint.mimic) return;
  const int other = model.jointIndex(joint.mimic->joint);
  if (!joint.isAxial() || !model.links[static_cast<std::size_t>(other)].joint.isAxial() ||
      joint.mimic->joint == joint.name)
    raiseInputError(model.source, "joint \"", joint.name, "\": it mimics \"", joint.mimic->joint,
                    "\"; both must be revolute or prismatic, and not the same");
}

/// A rigid link takes in another one, which has `pose` in its frame.
void takeIn(LinkModel& into, const LinkModel& link, const RigidPose& pose) {
  const double mass = into.mass + link.mass;
  if (link.mass > 0) {
    const Vector3 centre = pose * link.centre_of_mass;
    const Vector3 common = (into.mass * into.centre_of_mass + link.mass * centre) / mass;
    const auto about_common = [&](double of, const Vector3& at) {
      const Vector3 r = at - common;
      return Matrix3(of * (r.squaredNorm() * Matrix3::Identity() - r * r.transpose()));
    };
    into.inertia += about_common(into.mass, into.centre_of_mass) + about_common(link.mass, centre) +
                    pose.linear() * link.inertia * pose.linear().transpose();
    into.centre_of_mass = common;
    into.mass = mass;
  }
  for (PlacedShape part : link.collisions) {
    part.pose = pose * part.pose;
    into.collisions.push_back(std::move(part));
  }
  into.merged[link.name] = pose;
  for (const auto& [name, inner] : link.merged) into.merged[name] = pose * inner;
}

bool isEmpty(const LinkModel& link) { return link.mass == 0 && link.collisions.empty(); }

/// Whether the root is only a name for the world, in which its child floats.
bool floatsInRoot(const RobotModel& model) {
  return model.links.size() > 1 && isEmpty(model.links[0]) &&
         model.links[1].joint.kind == UrdfJointKind::kFloating &&
         std::count_if(model.links.begin(), model.links.end(),
                       [](const LinkModel& link) { return link.parent == 0; }) == 1;
}

RobotModel withoutRoot(RobotModel model) {
  const LinkModel root = model.links.front();
  model.links.erase(model.links.begin());
  for (LinkModel& link : model.links) --link.parent;
  LinkModel& base = model.links.front();
  const RigidPose base_in_root = base.joint.origin;
  base.merged[root.name] = base_in_root.inverse();
  base.joint = {};
  base.joint.origin = root.joint.origin * base_in_root;
  return model;
}

/// Merges links at fixed joints with their parents, as far as may(link).
template <class May>
RobotModel merged(const RobotModel& model, const May& may) {
  RobotModel merged = model;
  merged.links.clear();
  // For each link: the index of the link that holds it after merging, and its pose in that link's
  // frame.
  std::vector<std::pair<int, RigidPose>> holders;
  for (const LinkModel& link : model.links) {
    const bool merges = link.parent >= 0 && link.joint.kind == UrdfJointKind::kFixed && may(link);
    LinkModel kept = link;
    if (link.parent >= 0) {
      const auto& [holder, pose] = holders[static_cast<std::size_t>(link.parent)];
      kept.parent = holder;
      kept.joint.origin = pose * link.joint.origin;
    }
    if (merges) {
      takeIn(merged.links[static_cast<std::size_t>(kept.parent)], link, kept.joint.origin);
      holders.emplace_back(kept.parent, kept.joint.origin);
    } else {
      holders.emplace_back(static_cast<int>(merged.links.size()), RigidPose::Identity());
      merged.links.push_back(std::move(kept));
    }
  }
  return floatsInRoot(merged) ? withoutRoot(std::move(merged)) : merged;
}

/// Finds the link with mass that fixed joints hold to a link, and the given link's pose in its
/// frame; -1: there is none, or it is held to a fixed base.
std::pair<int, RigidPose> findCarrier(const RobotModel& model, int link, bool fixed_base) {
  std::vector<std::pair<int, RigidPose>> reached{{link, RigidPose::Identity()}};
  const auto reach = [&](int next, const RigidPose& pose) {
    if (std::none_of(reached.begin(), reached.end(),
                     [next](const auto& known) { return known.first == next; }))
      reached.emplace_back(next, pose);
  };
  const auto at = [&](int index) -> const LinkModel& {
    return model.links[static_cast<std::size_t>(index)];
  };
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const auto [here, pose] = reached[i];
    if (here == 0 && fixed_base) break;
    if (at(here).mass > 0) return {here, pose};
    if (here > 0 && at(here).joint.kind == UrdfJointKind::kFixed)
      reach(at(here).parent, at(here).joint.origin * pose);
    for (int child = here + 1; child < static_cast<int>(model.links.size()); ++child)
      if (at(child).parent == here && at(child).joint.kind == UrdfJointKind::kFixed)
        reach(child, at(child).joint.origin.inverse() * pose);
  }
  return {-1, RigidPose::Identity()};
}

}  // namespace

int RobotModel::linkIndex(const std::string& link) const {
  return findLink(
      *this, "link \"" + link + "\"",
      [&](const LinkModel& l) { return l.name == link || l.merged.count(link) > 0; },
      [](const LinkModel& l) { return l.name; });
}

int RobotModel::jointIndex(const std::string& joint) const {
  return findLink(
      *this, "joint \"" + joint + "\"",
      [&](const LinkModel& l) { return l.parent >= 0 && l.joint.name == joint; },
      [](const LinkModel& l) { return l.parent >= 0 ? l.joint.name : ""; });
}

void checkRobot(const RobotModel& model, bool fixed_base) {
  const RobotModel rigid = merged(model, [](const LinkModel&) { return true; });
  for (const LinkModel& link : rigid.links)
    if (link.parent >= 0 || !fixed_base) checkMovingLink(model, link);
  for (const LinkModel& link : model.links) {
    if (link.parent < 0) continue;
    const JointModel& joint = link.joint;
    if (joint.kind == UrdfJointKind::kFloating)
      raiseInputError(model.source, "joint \"", joint.name,
                      "\": it is floating; only the one child of a root without mass and collision "
                      "may float");
    checkMimic(model, joint);
  }
}

RobotModel withoutFixedJoints(const RobotModel& model) {
  return merged(model, [](const LinkModel& link) { return !link.fluid; });
}

RobotModel withCarriedCollisions(RobotModel model, bool fixed_base) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    LinkModel& link = model.links[i];
    if (link.mass > 0 || link.collisions.empty() || link.fluid) continue;
    const auto [carrier, pose] = findCarrier(model, static_cast<int>(i), fixed_base);
    if (carrier < 0) continue;
    for (PlacedShape part : std::exchange(link.collisions, {})) {
      part.pose = pose * part.pose;
      model.links[static_cast<std::size_t>(carrier)].collisions.push_back(std::move(part));
    }
  }
  return model;
}

std::vector<RigidPose> linkPoses(const RobotModel& model, const RigidPose& robot,
                                 const std::map<std::string, double>& positions) {
  std::vector<RigidPose> poses;
  for (const LinkModel& link : model.links) {
    const RigidPose& parent =
        link.parent < 0 ? robot : poses[static_cast<std::size_t>(link.parent)];
    const auto found = positions.find(link.joint.name);
    const double position = found == positions.end() ? 0 : found->second;
    poses.push_back(parent * link.joint.origin * link.joint.motion(position));
  }
  return poses;
}

namespace {

namespace fs = std::filesystem;

/// Empty: there is none.
fs::path findPackage(const std::string& name, const fs::path& file,
                     const PackageFolders& packages) {
  const auto given = packages.find(name);
  if (given != packages.end()) return given->second;
  std::error_code error;
  fs::path folder = fs::absolute(file, error).lexically_normal().parent_path();
  for (;; folder = folder.parent_path()) {
    if (folder.filename() == name) return folder;
    if (fs::is_directory(folder / name, error)) return folder / name;
    if (folder == folder.parent_path()) return {};
  }
}

}  // namespace

fs::path resolveReference(const std::string& reference, const fs::path& file,
                          const PackageFolders& packages, const std::string& source) {
  if (reference.empty()) raiseInputError(source, "the name of a file is empty");
  const std::size_t colon = reference.find("://");
  if (colon == std::string::npos) return file.parent_path() / reference;
  const std::string scheme = reference.substr(0, colon);
  const std::string rest = reference.substr(colon + 3);
  if (scheme == "file") return rest;
  if (scheme != "package" && scheme != "model")
    raiseInputError(source, "\"", reference, "\" begins with ", scheme,
                    "://; must be a path, file://, package:// or model://");
  const std::size_t slash = rest.find('/');
  const std::string name = rest.substr(0, slash);
  const fs::path folder = name.empty() ? fs::path() : findPackage(name, file, packages);
  if (folder.empty() || slash == std::string::npos)
    raiseInputError(source, "\"", reference, "\": no folder of package \"", name,
                    "\" was given or is above the file");
  return folder / rest.substr(slash + 1);
}

}  // namespace ambient
