// Plays random scenes until the time is over, or as many as are asked for, or a check fails:
// world_fuzz [--seconds S] [--seed N] [--scenes M]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/fuzz/fuzz_scene.h"

namespace {

constexpr int kEventsPerScene = 300;

struct Options {
  double seconds = 15;
  unsigned seed = 1;
  unsigned scenes = 1000000000;
};

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--seconds") {
      options.seconds = std::atof(argv[i + 1]);
    } else if (name == "--seed") {
      options.seed = static_cast<unsigned>(std::strtoul(argv[i + 1], nullptr, 10));
    } else if (name == "--scenes") {
      options.scenes = static_cast<unsigned>(std::strtoul(argv[i + 1], nullptr, 10));
    } else {
      return false;
    }
  }
  return argc % 2 == 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) {
    std::fprintf(stderr, "usage: world_fuzz [--seconds S] [--seed N] [--scenes M]\n");
    return 2;
  }
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  long long steps = 0;
  unsigned seed = options.seed;
  for (; Clock::now() < end && seed - options.seed < options.scenes; ++seed) {
    int event = 0;
    try {
      ambient::test::FuzzScene scene(seed);
      for (; event < kEventsPerScene && Clock::now() < end; ++event) scene.play();
      steps += scene.steps();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "world_fuzz --seed %u fails at event %d: %s\n", seed, event,
                   error.what());
      return 1;
    }
  }
  std::printf("%u scenes from seed %u, %lld steps: nothing found.\n", seed - options.seed,
              options.seed, steps);
  return 0;
}
