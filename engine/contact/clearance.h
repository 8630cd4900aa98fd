// Cached separation: what a pair of bodies knows of its distance from earlier narrow phases, as bounds, not guesses.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "engine/geometry/hyper_ellipsoid_mesh.h"
#include "engine/geometry/hyper_ellipsoid_pair.h"
#include "engine/math/types.h"

namespace engine {

/// What is known of the distance between two bodies: at least `least` when the second stood at `X` in the frame of the first.
/// Spares a pair its narrow phase for as long as it cannot matter; a bound, not a guess.
struct Clearance {
  double least = -std::numeric_limits<double>::infinity();  // [m] not known yet; negative: as deep as they met
  Pose X;
  double most = std::numeric_limits<double>::infinity();  // [m] of two that met

  /// Two surfaces were seen `apart` now. What was inside by more than it has gone since is inside still, where a look finds nothing
  /// of it: over a crack in a mesh, say.
  void note(double apart, const Pose& X_now, double reach) {
    const double way = std::isfinite(least) ? least - by_now(X_now, reach) : 0;
    const bool missed = most + way < 0 && apart > most + way;
    least = missed ? least - way : apart;
    most = missed ? most + way : apart < 0 ? apart : std::numeric_limits<double>::infinity();
    X = X_now;
  }

  /// Farther apart than `margin` still, wherever the second body has gone since? Its points lie within `reach` of its centre [m].
  bool beyond(double margin, const Pose& X_now, double reach) const { return least > margin && by_now(X_now, reach) > margin; }

  /// The least distance [m] they can have now that the second body stands at X_now.
  double by_now(const Pose& X_now, double reach) const {
    // |dq| = 2 sin(angle/4), so 2 |dq| bounds the chord 2 sin(angle/2) of a point at distance one
    const double dq =
        std::sqrt(std::min((X_now.q.coeffs() - X.q.coeffs()).squaredNorm(), (X_now.q.coeffs() + X.q.coeffs()).squaredNorm()));
    return least - (X_now.p - X.p).norm() - 2 * dq * reach;
  }

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.least, s.X, s.most);
  }
};

/// What a pair of hyper-ellipsoids keeps from step to step.
struct PairMemory {
  Vec3 normal_A = Vec3::Zero();  // of the last narrow phase, in a's axes; zero: none yet
  Vec3 turn_A = Vec3::Zero();    // its change since the one before
  Clearance clearance;           // of b in the frame of a
  OtherNormals others;           // of the two deep in each other

  /// The unit normal a narrow phase starts from, as if it went on as before; zero: none yet.
  Vec3 next_normal() const { return turn_A.isZero(0) ? normal_A : Vec3((normal_A + turn_A).normalized()); }

  /// `searched`: not just the one that it started from, which may do to tell that they are apart.
  void note_normal(const Vec3& normal, bool searched) {
    constexpr double kSteady = 0.1;  // [rad] what turns by more does not go on so
    const bool steady = searched && !normal_A.isZero(0) && (normal - normal_A).norm() < kSteady;
    turn_A = steady ? Vec3(normal - normal_A) : Vec3(Vec3::Zero());
    if (searched) normal_A = normal;
  }

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.normal_A, s.turn_A, s.clearance, s.others);
  }
};

/// What a hyper-ellipsoid and a mesh keep.
struct MeshMemory {
  Clearance clearance;  // of the body in the frame of the mesh
  Sides entered = 0;

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.clearance, s.entered);
  }
};

/// What two meshes whose sample points may meet the other's surface keep: of b in the frame of a, points of a on b and points of b
/// on a.
using BodyworkClearance = std::array<Clearance, 2>;

/// Contact memory of a run, in the order of the pairs in ContactPairs.
struct ContactMemory {
  std::vector<MeshMemory> mesh;                // per MeshPair
  std::vector<std::vector<PairMemory>> round;  // per BodyPairRun and pair; empty until the run is listed
  std::vector<BodyworkClearance> bodywork;     // per pair of meshes

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.mesh, s.round, s.bodywork);
  }
};

}  // namespace engine
