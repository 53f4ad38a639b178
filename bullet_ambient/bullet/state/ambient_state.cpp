#include "bullet_ambient/bullet/state/ambient_state.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_links.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/region_following.h"

AMBIENT_BEGIN

bool floatAgain(AmbientBody& ambient, const RigidState& now, const FluidRegions& regions) noexcept {
  if (!ambient.place.is_at_surface || !lastPlane(ambient)) return false;
  const auto entry = regions.all().find(ambient.place.region);
  if (entry == regions.all().end()) return false;
  const int media = ambient.models->findSurface(SurfaceKind(entry->second.region));
  if (media >= 0) restoreFloating(ambient, now, media);
  return media >= 0;
}

namespace {

std::unique_ptr<AmbientLink> makeLink(const LinkFluidState& saved, const MultiBodyState& state,
                                      AmbientBodies& registered) {
  const auto index = static_cast<std::size_t>(saved.link) + 1;
  if (saved.link < -1 || index >= state.links.size())
    throw std::invalid_argument("restoreState: a fluid is that of link " +
                                std::to_string(saved.link) + ", which the state has not");
  auto link = std::make_unique<AmbientLink>(saved.link);
  link->mass = inverseOf(state.links[index].mass, state.links[index].inertia);
  link->ambient = makeAmbient(saved.ambient, link->mass, registered);
  return link;
}

}  // namespace

AmbientState saveAmbient(const AmbientBody& ambient, const InverseMass& mass) {
  const auto* last = std::get_if<LastFlight>(&ambient.outcome.motion);
  const LastFlight flight = last ? *last : LastFlight{};
  AmbientState state{*ambient.def,
                     ambient.medium,
                     ambient.place,
                     ambient.flow,
                     flight.memory,
                     ambient.floating ? ambient.floating->waves : WaveMemory{},
                     lastPlane(ambient),
                     ambient.wake ? *ambient.wake : Wake{},
                     false,
                     false,
                     {},
                     {},
                     {},
                     {},
                     flight.left_W,
                     ambient.counters};
  if (ambient.vessel) {
    state.has_met_water = ambient.vessel->is_known;
    state.has_sunk = ambient.vessel->has_sunk;
    state.holds = ambient.vessel->holds;
    state.sloshing = ambient.vessel->sloshing.now;
    state.is_shut = ambient.vessel->changes.is_shut;
    state.holes = ambient.vessel->changes.holes;
  }
  if (isModelStale(ambient, mass)) state.memory = {};  // as the next step will do
  return state;
}

void saveFluids(const AmbientTree& tree, MultiBodyState& state) {
  Coordinates now(tree.step.end.size());
  readVelocity(*tree.multi_body, now);
  const bool was_moved = tree.tree.size() > 1 && wasMovedByOthers(tree, now);
  for (const auto& link : tree.links) {
    LinkFluidState& saved = state.fluids.emplace_back();
    saved.link = link->link;
    saved.ambient = saveAmbient(link->ambient, link->mass);
    if (was_moved) saved.ambient.memory = {};  // as the next step will do
  }
  state.turn_reserve = tree.step.reserve;
}

namespace {

// Gives a body the water in its holds.
void fillHolds(const AmbientState& saved, AmbientBody& ambient) {
  const std::vector<Hold>& holds = ambient.def->fluid_body->holds;
  bool fits = saved.holds.size() == holds.size() && saved.sloshing.size() == holds.size();
  std::size_t openings = saved.holes.size();
  for (std::size_t i = 0; i < holds.size() && fits; ++i) {
    fits = saved.holds[i].volume <= holds[i].volume;
    openings += holds[i].openings.size();
  }
  const auto isOther = [&](const AddedHole& hole) {
    return hole.hold < 0 || static_cast<std::size_t>(hole.hold) >= holds.size();
  };
  const bool opens = saved.is_shut.size() == openings &&
                     std::none_of(saved.holes.begin(), saved.holes.end(), isOther);
  if (!fits || !opens)
    throw std::invalid_argument("restoreState: the state has more water, or more holds" +
                                std::string(fits ? " and openings" : "") + ", than fluid body '" +
                                ambient.def->fluid_body->name + "' has room for");
  if (!ambient.vessel) return;
  for (const AddedHole& hole : saved.holes) addHole(hole, *ambient.vessel);
  ambient.vessel->changes.is_shut = saved.is_shut;
  ambient.vessel->is_known = saved.has_met_water;
  ambient.vessel->has_sunk = saved.has_sunk;
  ambient.vessel->holds = saved.holds;
}

}  // namespace

AmbientBody makeAmbient(const AmbientState& saved, const InverseMass& mass,
                        AmbientBodies& registered) {
  if (!saved.def.fluid_body)
    throw std::invalid_argument("restoreState: an attached body of the state has no fluid body");
  checkDef("restoreState: body with fluid body '" + saved.def.fluid_body->name + "'", saved.def);
  AmbientBody ambient;
  ambient.def = shareDef(saved.def, registered.load_tables);
  refreshModels(ambient, mass, registered.regions, registered.load_tables);
  fillHolds(saved, ambient);
  // A region that does not exist here is left to the next step.
  enterMedium(ambient, saved.place, saved.medium);
  ambient.flow = saved.flow;
  LastFlight& flight = ambient.outcome.flight();
  flight.memory = saved.memory;
  flight.left_W = saved.left_W;
  if (ambient.floating && ambient.place.is_at_surface) {
    ambient.floating->waves = saved.waves;
    if (ambient.vessel) ambient.vessel->sloshing.now = saved.sloshing;
    if (saved.met_B) ambient.floating->setPlane(*saved.met_B);
  }
  if (ambient.wake) *ambient.wake = saved.wake;
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
  registered.trees.replace(world, body, std::move(links));
  AmbientTree* tree = registered.trees.find(&body);
  if (!tree) return;
  tree->step.reserve = state.turn_reserve;
  for (const auto& link : tree->links) link->now.gravity = toVector3(world.getGravity());
  placeLinksNow(*tree);
  tree->step.end = tree->step.start;
  for (const auto& link : tree->links)
    if (floatAgain(link->ambient, link->now.state, registered.regions))
      link->frozen.freeze(link->ambient);
}

AMBIENT_END
