#include "demos/pybullet/region_command.h"

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "bullet_ambient/force/medium/waves.h"

namespace ambient::pybullet {
namespace {

Vector3 directionIn(const std::vector<double>& numbers) {
  return numbers.size() < 5 ? Vector3::UnitX() : Vector3(numbers[2], numbers[3], numbers[4]);
}

// Reads "spectrum": significant height [m], peak period [s], direction (3), peak enhancement,
// number of waves, seed; only the first two are mandatory.
std::vector<WaveComponent> readSpectrum(Command& command) {
  if (!command.has("spectrum")) return {};
  const std::vector<double> numbers = command.numbers("spectrum", 2, 8);
  WaveSpectrum spectrum;
  spectrum.significant_height = numbers[0];
  spectrum.peak_period = numbers[1];
  spectrum.direction = directionIn(numbers);
  const auto whole = [&](std::size_t index) {
    const double number = numbers[index];
    if (number < 0 || number > 1e9 || number != std::floor(number))
      command.fail("spectrum: number of waves and seed are whole numbers from 0 to 1e9");
    return number;
  };
  if (numbers.size() > 5) spectrum.peak_enhancement = numbers[5];
  if (numbers.size() > 6) spectrum.components = static_cast<int>(whole(6));
  if (numbers.size() > 7) spectrum.seed = static_cast<std::uint64_t>(whole(7));
  return wavesOf(spectrum);
}

// Reads "waves": lists of amplitude [m], period [s], direction (3), phase [rad]; only the first two
// are mandatory. Adds those of "spectrum".
std::vector<WaveComponent> readWaves(Command& command) {
  std::vector<WaveComponent> waves = readSpectrum(command);
  for (const std::vector<double>& numbers : command.lists("waves", 2, 6)) {
    const double phase = numbers.size() > 5 ? numbers[5] : 0;
    waves.push_back({numbers[0], numbers[1], directionIn(numbers), phase});
  }
  return waves;
}

void addSurface(Command& command, FluidRegion& region) {
  CalmSea sea;
  sea.level = command.number("level", 0);
  sea.up = command.vector("up", sea.up);
  sea.gravity = command.number("gravity", sea.gravity);
  sea.current = command.vector("current", sea.current);
  if (command.has("wind")) {
    region.above = air();
    region.above->velocity = command.vector("wind", Vector3::Zero());
  }
  const std::vector<WaveComponent> waves = readWaves(command);
  if (waves.empty()) {
    region.surface = std::make_shared<StillWater>(sea.level, sea.up);
    region.below.velocity = sea.current;
  } else {
    region.surface = std::make_shared<AiryWaves>(sea, waves);
  }
}

std::optional<RegionBounds> readBounds(Command& command) {
  if (!command.has("bounds")) return std::nullopt;
  const std::vector<double> x = command.numbers("bounds", 6, 6);
  return RegionBounds{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

FluidRegion readRegion(Command& command) {
  FluidRegion region;
  region.below = command.name() == "air" ? air() : water();
  region.below.density = command.number("density", region.below.density);
  region.below.viscosity = command.number("viscosity", region.below.viscosity);
  region.bounds = readBounds(command);
  region.priority = static_cast<int>(command.number("priority", 0));
  if (command.name() == "water") {
    addSurface(command, region);
  } else {
    const char* key = command.name() == "air" ? "wind" : "velocity";
    region.below.velocity = command.vector(key, Vector3::Zero());
  }
  return region;
}

}  // namespace

FluidRegion makeRegion(Command& command) {
  try {
    const FluidRegion region = readRegion(command);
    checkRegion(region);
    command.finish();
    return region;
  } catch (const std::invalid_argument& error) {
    const std::string said = error.what();
    if (said.rfind(command.name() + ": ", 0) == 0) throw;
    command.fail(said);
  }
}

}  // namespace ambient::pybullet
