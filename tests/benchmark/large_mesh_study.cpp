// Time, memory and error of the hierarchical solver against the number of panels: a table in
// Markdown. Each line is a process of its own, to measure its own peak of memory.
//   large_mesh_study [--threads N] [--most-dense FACES] [SHAPE FACES ...]

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/potential_flow.h"

namespace ambient {
namespace {

struct Study {
  std::string shape = "sphere";
  std::vector<int> faces = {4000, 20000, 40000, 100000, 300000};
  int threads = 2;
  int most_dense = 8000;  ///< faces up to which the dense solver runs for comparison
};

TriangleMesh makeMesh(const std::string& shape, int faces) {
  if (shape == "sphere") return makeEllipsoidMesh({1, 1, 1}, faces);
  if (shape == "oblate") return makeEllipsoidMesh({1, 1, 0.02}, faces);
  if (shape == "box") return makeBoxMesh({1, 1, 0.1}, faces);
  if (shape == "cylinder") return makeCylinderMesh(1, 1, faces);
  if (shape == "sheet") return makeRectangularSheetMesh(1, 1, faces);
  std::fprintf(stderr, "%s is not sphere, oblate, box, cylinder or sheet\n", shape.c_str());
  std::exit(2);
}

/// Largest difference over the largest entry, for one diagonal block.
double blockError(const Matrix6& a, const Matrix6& b, int first) {
  const auto difference = (a - b).block<3, 3>(first, first);
  return difference.cwiseAbs().maxCoeff() / b.block<3, 3>(first, first).cwiseAbs().maxCoeff();
}

double processorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Solves and prints the first columns of a line; for the dense solver its time and error only.
void runCase(const Study& study, int faces) {
  const TriangleMesh mesh = makeMesh(study.shape, faces);
  PotentialFlowSettings settings;
  settings.sheet = study.shape == "sheet";
  settings.threads = study.threads;
  settings.solver = FlowSolverKind::Hierarchical;
  const double processor = processorSeconds();
  const auto start = std::chrono::steady_clock::now();
  const PotentialFlow flow = solvePotentialFlow(mesh, settings);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("| %s | %ld | %d | %.2f | %.2f | %.0f |", study.shape.c_str(),
              static_cast<long>(flow.panels), flow.iterations, seconds.count(),
              processorSeconds() - processor, static_cast<double>(usage.ru_maxrss) / 1024);
  if (flow.panels > study.most_dense) {
    std::printf(" | | |\n");
    return;
  }
  settings.solver = FlowSolverKind::Dense;
  const double dense = processorSeconds();
  const Matrix6 exact = solvePotentialFlow(mesh, settings).added_mass;
  std::printf(" %.2f | %.1e | %.1e |\n", processorSeconds() - dense,
              blockError(flow.added_mass, exact, 0), blockError(flow.added_mass, exact, 3));
}

Study parse(int argc, char** argv) {
  Study study;
  for (int k = 1; k < argc; ++k) {
    const bool has_value = k + 1 < argc;
    if (std::strcmp(argv[k], "--threads") == 0 && has_value) {
      study.threads = std::atoi(argv[++k]);
    } else if (std::strcmp(argv[k], "--most-dense") == 0 && has_value) {
      study.most_dense = std::atoi(argv[++k]);
    } else if (std::atoi(argv[k]) > 0) {
      study.faces.push_back(std::atoi(argv[k]));
    } else {
      study.shape = argv[k];
      study.faces.clear();
    }
  }
  return study;
}

int run(int argc, char** argv) {
  const Study study = parse(argc, argv);
  std::printf(
      "| shape | panels | iterations | seconds | processor seconds | MB | dense, processor seconds "
      "| rotation | translation |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const int faces : study.faces) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
      runCase(study, faces);
      std::fflush(stdout);
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0) return 1;
  }
  return 0;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) { return ambient::run(argc, argv); }
