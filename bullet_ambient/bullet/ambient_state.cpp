#include "bullet_ambient/bullet/ambient_state.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/attach_body.h"
#include "bullet_ambient/bullet/region_following.h"
#include "bullet_ambient/bullet/tree_links.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// The inertia of a link at the surface is that of the start of its last substep, which the next one
// compares with its own.
void meetSurfaceAgain(AmbientBody& ambient, const FluidRegions& regions) {
  if (!ambient.place.is_at_surface || !ambient.encounter.met_B) return;
  const auto entry = regions.all().find(ambient.place.region);
  if (entry == regions.all().end()) return;
  const int media = findSurface(ambient.surfaces, SurfaceKind(entry->second.region));
  if (media >= 0) freezeAsMet(ambient, media);
}

std::unique_ptr<AmbientLink> makeLink(const LinkFluidState& saved, const MultiBodyState& state,
                                      AmbientBodies& registered) {
  const auto index = static_cast<std::size_t>(saved.link) + 1;
  if (saved.link < -1 || index >= state.links.size())
    throw std::invalid_argument("restoreState: a fluid is that of link " +
                                std::to_string(saved.link) + ", which the state has not");
  auto link = std::make_unique<AmbientLink>(saved.link);
  link->stand_in.setMassProps(state.links[index].mass, state.links[index].inertia);
  link->ambient = makeAmbient(saved.ambient, link->stand_in, registered);
  return link;
}

}  // namespace

AmbientState saveAmbient(const AmbientBody& ambient) {
  AmbientState state{ambient.def,    ambient.medium,          ambient.place,
                     ambient.memory, ambient.encounter.waves, ambient.encounter.met_B,
                     ambient.left_W, ambient.counters};
  if (isModelStale(ambient)) state.memory = {};  // as the next step will do
  return state;
}

void saveFluids(const AmbientTree& tree, MultiBodyState& state) {
  for (const auto& link : tree.links) {
    const Link& in_tree = tree.tree.links[link->link + 1];
    LinkFluidState& saved = state.fluids.emplace_back();
    saved.link = link->link;
    if (in_tree.model) saved.flow = in_tree.surroundings.ambient_velocity;
    saved.ambient = saveAmbient(link->ambient);
  }
  state.turn_reserve = tree.step.reserve;
}

AmbientBody makeAmbient(const AmbientState& saved, btRigidBody& body, AmbientBodies& registered) {
  if (!saved.def.fluid_body)
    throw std::invalid_argument("restoreState: an attached body of the state has no fluid body");
  checkDef("restoreState: body with fluid body '" + saved.def.fluid_body->name + "'", saved.def);
  AmbientBody ambient;
  ambient.body = &body;
  ambient.def = saved.def;
  refreshModel(ambient, registered.regions, registered.load_tables);
  // Of a region that is not here, the next step tells.
  if (enterMedium(ambient, saved.place, saved.medium) && isModelStale(ambient) &&
      body.getInvMass() > 0)
    rebuildModel(ambient);
  ambient.memory = saved.memory;
  ambient.encounter.waves = saved.waves;
  ambient.encounter.met_B = saved.met_B;
  ambient.left_W = saved.left_W;
  ambient.counters = saved.counters;
  return ambient;
}

std::vector<std::unique_ptr<AmbientLink>> makeLinks(const MultiBodyState& state,
                                                    AmbientBodies& registered) {
  std::vector<std::unique_ptr<AmbientLink>> links;
  for (const LinkFluidState& saved : state.fluids) {
    for (const auto& other : links)
      if (other->link == saved.link)
        throw std::invalid_argument("restoreState: the state has two fluids of link " +
                                    std::to_string(saved.link));
    links.push_back(makeLink(saved, state, registered));
  }
  return links;
}

void insertLinks(const MultiBodyState& state, std::vector<std::unique_ptr<AmbientLink>> links,
                 btMultiBodyDynamicsWorld& world, btMultiBody& body, AmbientBodies& registered) {
  registered.trees.erase(body);
  for (auto& link : links) registered.trees.insert(world, body, std::move(link));
  AmbientTree* tree = registered.trees.find(&body);
  if (!tree) return;
  tree->step.reserve = state.turn_reserve;
  moveStandIns(*tree);
  for (const auto& link : tree->links) meetSurfaceAgain(link->ambient, registered.regions);
  for (std::size_t i = 0; i < state.fluids.size(); ++i) {
    if (!state.fluids[i].flow) continue;
    Link& in_tree = tree->tree.links[state.fluids[i].link + 1];
    in_tree.model = &tree->links[i]->ambient.model;
    in_tree.surroundings.ambient_velocity = *state.fluids[i].flow;
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
