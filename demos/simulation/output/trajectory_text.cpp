#include "demos/simulation/output/trajectory_text.h"

#include "demos/simulation/output/digits.h"

namespace ambient {

std::string trajectoryRow(const std::string& body, const MotionSample& sample) {
  const Vector3& p = sample.position;
  const Quaternion& q = sample.orientation;
  const Vector3& w = sample.twist.angular;
  const Vector3& v = sample.twist.linear;
  std::string row = digits17(sample.time) + "," + body;
  for (const double value :
       {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), w.x(), w.y(), w.z(), v.x(), v.y(), v.z()})
    row += "," + digits17(value);
  return row + "\n";
}

std::string makeTrajectoryText(const Scene& scene,
                               const std::vector<std::vector<MotionSample>>& motion,
                               const std::string& further_names,
                               const std::vector<std::vector<std::string>>& further) {
  std::string text = kTrajectoryHeader + further_names + "\n";
  for (std::size_t row = 0; row < motion.front().size(); ++row)
    for (std::size_t body = 0; body < motion.size(); ++body) {
      text += trajectoryRow(scene.bodies[body].name, motion[body][row]);
      if (!further.empty()) text.insert(text.size() - 1, further[body][row]);
    }
  return text;
}

}  // namespace ambient
