#include "preprocess/mesh/wings/wing_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/base/numerics.h"
#include "preprocess/mesh/wings/triangle_tree.h"
#include "preprocess/mesh/wings/wing_numbers.h"

namespace ambient {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Chosen = std::vector<int>;  // numbers of samples

constexpr int kSamples = 3000;
constexpr double kApart = 2.2;        // spacings between neighbours
constexpr double kBend = 0.81915204;  // cos 35 degrees: neighbours of one wing face alike
constexpr double kMostRatio = 4;      // of their thicknesses
constexpr double kLeastArea = 0.01;   // of a wing over that of the body
constexpr std::size_t kFewest = 12;   // samples of a wing
constexpr double kConvex = 0.75;      // area over that of the convex hull
constexpr double kPitched = 0.08;     // 1 - phi from which on blades are looked for
constexpr double kLeastWing = 0.3;    // W of eq. (45a)
constexpr double kOneSided = 0.5;     // mean of the normals of a skin that has no other side

/// Plane through samples: their normals, mean place, and extents in the plane.
struct Planform {
  Vector3 facing{0, 0, 0}, span{0, 0, 0}, centre{0, 0, 0};
  double one_sided = 0;                // length of the mean of the normals
  double phi = 0;                      // mean square of the normals' cosine to `facing`
  double along_sq = 0, across_sq = 0;  // variances [m^2]
};

class WingSearch {
 public:
  explicit WingSearch(const TriangleMesh& mesh)
      : mesh_(mesh),
        tree_(mesh),
        samples_(sampleSurface(mesh, tree_, kSamples)),
        part_(samples_.all.size()) {}

  std::vector<std::uint8_t> labels() {
    for (const Chosen& piece : pieces()) addArms(piece);
    if (wings_.empty() || wings_.size() > kMostWings) return {};
    addRims();
    if (isNearlyAll()) return all();
    std::vector<std::uint8_t> labels = labelsOfTriangles();
    addEdges(labels);
    mendIslands(labels);
    keep(labels, [](std::size_t) { return true; });  // of those that have a triangle
    dropWhatRunsOut(labels);
    const int count = static_cast<int>(wings_.size());
    if (count == 0 || count > kMostFoundWings) return {};
    return isWhole(labels, count) ? all() : labels;
  }

 private:
  struct Found {
    Chosen samples;
    Vector3 facing;
    int piece;  // of which it is an arm; kNoPiece: it is a piece of its own
  };
  static constexpr int kNoPiece = -1;

  const SurfaceSample& sample(int i) const { return samples_.all[static_cast<std::size_t>(i)]; }
  int count() const { return static_cast<int>(samples_.all.size()); }
  int& partOf(int i) { return part_[static_cast<std::size_t>(i)]; }
  bool isLarge(std::size_t samples) const {
    return samples >= kFewest && static_cast<double>(samples) >= kLeastArea * count();
  }
  bool faceAlike(int a, int b) const {
    return std::abs(sample(a).normal.dot(sample(b).normal)) > kBend;
  }

  /// Thin samples that hang together by their mean surface.
  std::vector<Chosen> pieces() const {
    DisjointSets sets(samples_.all.size());
    const double reach = kApart * samples_.spacing;
    for (int a = 0; a < count(); ++a) {
      if (!sample(a).is_thin) continue;
      for (int b = a + 1; b < count(); ++b) {
        if (!sample(b).is_thin) continue;
        if ((sample(a).middle - sample(b).middle).squaredNorm() > reach * reach) continue;
        const double ratio = sample(a).thickness / sample(b).thickness;
        if (faceAlike(a, b) && ratio < kMostRatio && 1 < ratio * kMostRatio) sets.join(a, b);
      }
    }
    std::map<int, Chosen> by_root;
    for (int i = 0; i < count(); ++i)
      if (sample(i).is_thin) by_root[sets.find(i)].push_back(i);
    std::vector<Chosen> found;
    for (auto& [root, piece] : by_root)
      if (piece.size() >= kFewest) found.push_back(withEnds(std::move(piece)));
    found.erase(std::remove_if(found.begin(), found.end(),
                               [&](const Chosen& piece) { return !isLarge(piece.size()); }),
                found.end());
    return found;
  }

  /// The sample of a list whose middle is nearest to a point, and the squared distance.
  std::pair<int, double> nearestIn(const Chosen& list, const Vector3d& point) const {
    std::pair<int, double> best{-1, std::numeric_limits<double>::infinity()};
    for (const int i : list)
      if (const double square = (sample(i).middle - point).squaredNorm(); square < best.second)
        best = {i, square};
    return best;
  }

  /// Adds the ends of thick plates, where lines across the normal are cut short.
  Chosen withEnds(Chosen piece) const {
    std::vector<double> thicknesses;
    for (const int i : piece) thicknesses.push_back(sample(i).thickness);
    const auto half = thicknesses.begin() + static_cast<std::ptrdiff_t>(thicknesses.size() / 2);
    std::nth_element(thicknesses.begin(), half, thicknesses.end());
    const double median = *half, reach = kApart * samples_.spacing + 0.25 * median;
    const Chosen thin = piece;
    for (int i = 0; i < count(); ++i) {
      if (sample(i).is_thin || sample(i).thickness > 1.3 * median) continue;
      const auto [near, square] = nearestIn(thin, sample(i).middle);
      if (square < reach * reach && faceAlike(i, near)) piece.push_back(i);
    }
    return piece;
  }

  Planform planformOf(const Chosen& piece) const {
    Planform plane;
    Matrix3 normals = Matrix3::Zero(), spread = Matrix3::Zero();
    Vector3 mean(0, 0, 0);
    const auto size = static_cast<double>(piece.size());
    for (const int i : piece) {
      const Vector3 n(sample(i).normal);
      normals += n * n.transpose() / size;
      mean += n / size;
      plane.centre += Vector3(sample(i).middle) / size;
    }
    const SymmetricEigen<3> of_normals = symmetricEigen<3>(normals);
    plane.facing = of_normals.vectors.col(2);
    plane.phi = of_normals.values[2];
    plane.one_sided = mean.norm();
    for (const int i : piece) {
      Vector3 d = Vector3(sample(i).middle) - plane.centre;
      d -= plane.facing.dot(d) * plane.facing;
      spread += d * d.transpose() / size;
    }
    const SymmetricEigen<3> extent = symmetricEigen<3>(spread);
    plane.span = extent.vectors.col(2);
    plane.along_sq = extent.values[2];
    plane.across_sq = std::max(extent.values[1], 0.0);
    return plane;
  }

  /// Places of samples in a plane.
  std::vector<Vector2d> inPlane(const Chosen& piece, const Planform& plane) const {
    const Vector3 across = plane.facing.cross(plane.span);
    std::vector<Vector2d> places;
    for (const int i : piece) {
      const Vector3 d = Vector3(sample(i).middle) - plane.centre;
      places.emplace_back(plane.span.dot(d), across.dot(d));
    }
    return places;
  }

  static double hullArea(std::vector<Vector2d> p) {
    const auto cross = [](const Vector2d& o, const Vector2d& a, const Vector2d& b) {
      return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
    };
    std::sort(p.begin(), p.end(), [](const Vector2d& a, const Vector2d& b) {
      return std::make_pair(a.x(), a.y()) < std::make_pair(b.x(), b.y());
    });
    double twice = 0;
    for (const int side : {0, 1}) {
      std::vector<Vector2d> chain;
      for (const Vector2d& next : p) {
        while (chain.size() > 1 && cross(chain[chain.size() - 2], chain.back(), next) <= 0)
          chain.pop_back();
        chain.push_back(next);
      }
      for (std::size_t i = 1; i < chain.size(); ++i)
        twice += chain[i - 1].x() * chain[i].y() - chain[i - 1].y() * chain[i].x();
      if (side == 0) std::reverse(p.begin(), p.end());
    }
    return twice / 2;
  }

  /// How much of its convex hull a planform fills: its samples are on two sides.
  double convexity(const std::vector<Vector2d>& places) const {
    const double own = static_cast<double>(places.size()) * samples_.spacing * samples_.spacing / 2;
    return std::min(1.0, own / std::max(hullArea(places), 1e-300));
  }

  /// Cuts a piece that is not convex, or whose normals spread, into the fewest arms that are.
  std::vector<Chosen> armsOf(const Chosen& piece) const {
    const Planform plane = planformOf(piece);
    const std::vector<Vector2d> places = inPlane(piece, plane);
    const bool is_flat = 1 - plane.phi <= kPitched, is_convex = convexity(places) >= kConvex;
    if (is_flat && is_convex) return {piece};
    constexpr int kMostArms = 6;
    constexpr double kGain = 0.1;  // by which each further arm must fill more of its hull
    std::vector<Chosen> best{piece};
    double best_worst = -1, most = -1;
    for (int arms = 2; arms <= kMostArms && most + kGain * arms < 1; ++arms)
      for (int start = 0; start < 4; ++start) {
        const std::vector<Chosen> cut = clustered(piece, places, arms, start);
        const double worst = worstOf(cut, plane, is_flat), gain = worst - kGain * arms;
        if (worst < 0 || gain <= most) continue;
        best = cut;
        best_worst = worst;
        most = gain;
      }
    return best_worst >= (is_convex ? kConvex : 0.5) ? best : std::vector<Chosen>{piece};
  }

  /// Least convexity of arms; -1 if they are too small, or neither incline alike nor are flatter
  /// than the whole.
  double worstOf(const std::vector<Chosen>& arms, const Planform& whole, bool is_flat) const {
    double worst = 1, least = 1, most = 0;
    for (const Chosen& arm : arms) {
      if (arm.size() < kFewest) return -1;
      const Planform plane = planformOf(arm);
      const double tilt = std::abs(plane.facing.dot(whole.facing));
      least = std::min(least, tilt);
      most = std::max(most, tilt);
      if (!is_flat && 1 - plane.phi > std::max(kPitched, 0.5 * (1 - whole.phi))) return -1;
      Planform seen = whole;
      seen.centre = plane.centre;
      worst = std::min(worst, convexity(inPlane(arm, seen)));
    }
    return is_flat || most - least <= 0.06 ? worst : -1;
  }

  /// k-means, from places far from each other.
  std::vector<Chosen> clustered(const Chosen& piece, const std::vector<Vector2d>& places, int arms,
                                int start) const {
    SplitMix64 random(static_cast<std::uint64_t>(start) + 17);
    std::vector<Vector2d> centres;
    const auto nearestSquare = [&](const Vector2d& place) {
      double least = std::numeric_limits<double>::infinity();
      for (const Vector2d& centre : centres)
        least = std::min(least, (place - centre).squaredNorm());
      return least;
    };
    const auto farthest = [&](const auto& distance) {
      return *std::max_element(
          places.begin(), places.end(),
          [&](const Vector2d& a, const Vector2d& b) { return distance(a) < distance(b); });
    };
    if (start == 0)
      centres.push_back(farthest([](const Vector2d& place) { return place.squaredNorm(); }));
    else
      centres.push_back(
          places[static_cast<std::size_t>(random.uniform() * static_cast<double>(places.size()))]);
    while (static_cast<int>(centres.size()) < arms) centres.push_back(farthest(nearestSquare));
    std::vector<int> of(places.size());
    for (int pass = 0; pass < 30; ++pass) {
      std::vector<Vector2d> sums(centres.size(), Vector2d::Zero());
      std::vector<double> counts(centres.size());
      for (std::size_t i = 0; i < places.size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < centres.size(); ++c)
          if (const double square = (places[i] - centres[c]).squaredNorm(); square < least) {
            least = square;
            of[i] = static_cast<int>(c);
          }
        sums[static_cast<std::size_t>(of[i])] += places[i];
        ++counts[static_cast<std::size_t>(of[i])];
      }
      for (std::size_t c = 0; c < centres.size(); ++c)
        if (counts[c] > 0) centres[c] = sums[c] / counts[c];
    }
    std::vector<Chosen> cut(centres.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      cut[static_cast<std::size_t>(of[i])].push_back(piece[i]);
    return cut;
  }

  void addArms(const Chosen& piece) {
    const std::vector<Chosen> arms = armsOf(piece);
    ++pieces_;
    for (const Chosen& arm : arms) {
      if (!isLarge(arm.size())) continue;
      const Planform plane = planformOf(arm);
      if (plane.one_sided > kOneSided) continue;
      double thickness = 0;
      for (const int i : arm) thickness += sample(i).thickness / static_cast<double>(arm.size());
      const double thick = thickness * thickness / (12 * plane.across_sq);
      const double aside = 1.5 * (1 - plane.phi);
      const double root = std::max(0.0, 1 - thick);
      if (root * root * std::max(0.0, 1 - aside * aside) < kLeastWing) continue;
      wings_.push_back({arm, plane.facing, arms.size() > 1 ? pieces_ : kNoPiece});
      for (const int i : arm) partOf(i) = static_cast<int>(wings_.size());
    }
  }

  /// Adds samples on the edges of wings, which look across their planes.
  void addRims() {
    std::vector<int> rims(part_.size());
    for (int i = 0; i < count(); ++i) {
      if (partOf(i) != 0) continue;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t w = 0; w < wings_.size(); ++w) {
        const auto [near, square] = nearestIn(wings_[w].samples, sample(i).place);
        const double reach = 0.6 * sample(near).thickness + 0.8 * samples_.spacing;
        const bool is_across = std::abs(wings_[w].facing.dot(Vector3(sample(i).normal))) < 0.8;
        if (square > reach * reach || square > least || !is_across) continue;
        least = square;
        rims[static_cast<std::size_t>(i)] = static_cast<int>(w) + 1;
      }
    }
    for (int i = 0; i < count(); ++i)
      if (partOf(i) == 0) partOf(i) = rims[static_cast<std::size_t>(i)];
  }

  /// The part that most samples of each triangle have; without samples that of the nearest one that
  /// looks the same way.
  std::vector<std::uint8_t> labelsOfTriangles() {
    const auto triangles = static_cast<std::size_t>(mesh_.triangleCount());
    std::vector<std::vector<int>> votes(triangles);
    for (int i = 0; i < count(); ++i)
      votes[static_cast<std::size_t>(sample(i).triangle)].push_back(partOf(i));
    std::vector<std::uint8_t> labels(triangles);
    for (std::size_t t = 0; t < triangles; ++t)
      labels[t] = static_cast<std::uint8_t>(
          votes[t].empty() ? partOf(nearestTo(static_cast<Eigen::Index>(t))) : mostOf(votes[t]));
    return labels;
  }

  /// Adds the triangles on the edges of wings, which look across their planes: few points lie
  /// there.
  void addEdges(std::vector<std::uint8_t>& labels) const {
    for (std::size_t w = 0; w < wings_.size(); ++w) {
      Eigen::AlignedBox3d box;
      for (const int i : wings_[w].samples) box.extend(sample(i).place);
      box.extend(Vector3d(box.min().array() - kApart * samples_.spacing));
      box.extend(Vector3d(box.max().array() + kApart * samples_.spacing));
      for (std::size_t t = 0; t < labels.size(); ++t) {
        const Vector3d place = mesh_.barycentre(static_cast<Eigen::Index>(t));
        if (labels[t] == 0 && box.contains(place) && isOnEdge(w, static_cast<Eigen::Index>(t)))
          labels[t] = static_cast<std::uint8_t>(w + 1);
      }
    }
  }

  bool isOnEdge(std::size_t wing, Eigen::Index triangle) const {
    const Vector3d place = mesh_.barycentre(triangle);
    const auto [near, square] = nearestIn(wings_[wing].samples, place);
    const SurfaceSample& by = sample(near);
    const double reach = 0.5 * by.thickness + 1.5 * samples_.spacing;
    return square < reach * reach &&
           std::abs(by.normal.dot(place - by.middle)) < 0.6 * by.thickness &&
           std::abs(by.normal.dot(mesh_.twiceArea(triangle).normalized())) < 0.8;
  }

  /// Gives small islands of triangles that border on one part alone to that part.
  void mendIslands(std::vector<std::uint8_t>& labels) const {
    constexpr double kSmall = 0.2;  // of the part around an island, and of the island's own part
    const std::vector<EdgePair> pairs = edgePairs(computeMeshEdges(mesh_));
    DisjointSets sets(labels.size());
    const auto at = [](int t) { return static_cast<std::size_t>(t); };
    for (const auto& [one, other] : pairs)
      if (labels[at(one.triangle)] == labels[at(other.triangle)])
        sets.join(one.triangle, other.triangle);
    std::vector<double> areas(labels.size()), of_label(kMostWings + 1);
    double whole = 0;
    for (std::size_t t = 0; t < labels.size(); ++t) {
      const double area = mesh_.twiceArea(static_cast<Eigen::Index>(t)).norm();
      areas[at(sets.find(static_cast<int>(t)))] += area;
      of_label[labels[t]] += area;
      whole += area;
    }
    if (of_label[0] < kLeastArea * whole) of_label[0] = whole;  // no body, but what was left over
    constexpr int kNone = -1, kSeveral = -2;
    std::vector<int> beside(labels.size(), kNone);  // of each island's first triangle
    for (const auto& [one, other] : pairs)
      for (const auto& [a, b] :
           {std::pair(one.triangle, other.triangle), std::pair(other.triangle, one.triangle)}) {
        int& label = beside[at(sets.find(a))];
        if (labels[at(a)] == labels[at(b)]) continue;
        label = label == kNone || label == labels[at(b)] ? labels[at(b)] : kSeveral;
      }
    const std::vector<std::uint8_t> before = labels;
    for (std::size_t t = 0; t < labels.size(); ++t) {
      const std::size_t root = at(sets.find(static_cast<int>(t)));
      if (beside[root] < 0) continue;
      const double around = of_label[at(beside[root])];
      if (areas[root] < kSmall * around && areas[root] < kSmall * of_label[before[t]])
        labels[t] = static_cast<std::uint8_t>(beside[root]);
    }
  }

  static int mostOf(std::vector<int> votes) {
    std::sort(votes.begin(), votes.end());
    int best = votes.front();
    std::size_t most = 0;
    for (std::size_t begin = 0, end = 0; begin < votes.size(); begin = end) {
      while (end < votes.size() && votes[end] == votes[begin]) ++end;
      if (end - begin <= most) continue;
      most = end - begin;
      best = votes[begin];
    }
    return best;
  }

  int nearestTo(Eigen::Index triangle) const {
    const Vector3d place = mesh_.barycentre(triangle);
    const Vector3d normal = mesh_.twiceArea(triangle).normalized();
    const double turn = 4 * samples_.spacing * samples_.spacing;
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < count(); ++i) {
      const double away =
          (sample(i).place - place).squaredNorm() + turn * (1 - sample(i).normal.dot(normal));
      if (away >= least) continue;
      least = away;
      best = i;
    }
    return best;
  }

  /// Drops wings without triangles and those that is_kept(index) refuses; numbers the rest anew.
  template <class IsKept>
  void keep(std::vector<std::uint8_t>& labels, const IsKept& is_kept) {
    std::vector<std::uint8_t> number(wings_.size() + 1);
    std::vector<Found> kept;
    for (std::size_t w = 0; w < wings_.size(); ++w) {
      if (std::find(labels.begin(), labels.end(), w + 1) == labels.end() || !is_kept(w)) continue;
      kept.push_back(wings_[w]);
      number[w + 1] = static_cast<std::uint8_t>(kept.size());
    }
    for (std::uint8_t& label : labels) label = number[label];
    wings_ = std::move(kept);
  }

  /// Drops parts that run out of the body, until none of those that border on each other does: what
  /// is dropped belongs to the body then. Arms stay or go together.
  void dropWhatRunsOut(std::vector<std::uint8_t>& labels) {
    for (std::size_t before = wings_.size() + 1; wings_.size() < before && !wings_.empty();) {
      before = wings_.size();
      const std::vector<MeasuredWing> measured = measureWings(mesh_, labels, false);
      std::set<int> thick;  // pieces with an arm that is too thick
      for (std::size_t w = 0; w < before; ++w)
        if (!(measured[w].wing.thickness < kThinPart * measured[w].wing.chord))
          thick.insert(wings_[w].piece);
      keep(labels, [&](std::size_t w) {
        if (wings_[w].piece != kNoPiece) return thick.count(wings_[w].piece) == 0;
        return standsOff(measured[w]) || isMost(labels, w + 1);
      });
    }
  }

  std::vector<std::uint8_t> all() const {
    return std::vector<std::uint8_t>(static_cast<std::size_t>(mesh_.triangleCount()), 1);
  }

  /// True if one wing has nearly all samples: the others lie on its rims.
  bool isNearlyAll() const {
    constexpr double kNearly = 0.95;
    const auto own = std::count(part_.begin(), part_.end(), 1);
    return wings_.size() == 1 && static_cast<double>(own) > kNearly * count();
  }

  /// True if a part has most of the area: what else there is stands on it, as the nut on the wing
  /// of a seed.
  bool isMost(const std::vector<std::uint8_t>& labels, std::size_t label) const {
    constexpr double kMost = 0.6;
    double own = 0, all = 0;
    for (std::size_t t = 0; t < labels.size(); ++t) {
      const double area = mesh_.twiceArea(static_cast<Eigen::Index>(t)).norm();
      all += area;
      if (labels[t] == label) own += area;
    }
    return own > kMost * all;
  }

  /// True if one wing, not joined and no aerofoil, is most of the body. Ellipses are none here.
  bool isWhole(const std::vector<std::uint8_t>& labels, int count) const {
    if (count > 1 || !isMost(labels, 1)) return false;
    const Wing wing = measureWings(mesh_, labels, false).front().wing;
    return !wing.is_joined && std::abs(wing.nose) != 1;
  }

  const TriangleMesh& mesh_;
  TriangleTree tree_;
  SurfaceSamples samples_;
  std::vector<int> part_;  // of each sample: 0 or the number of a wing
  int pieces_ = 0;         // whose arms were added
  std::vector<Found> wings_;
};

}  // namespace

std::vector<std::uint8_t> findWings(const TriangleMesh& mesh) { return WingSearch(mesh).labels(); }

}  // namespace ambient
