// Impulses of all contacts, limits and wheels of an island at once: Signorini's condition and the exact Coulomb cone, eq. (61).
//
//   u = G L + u_free,   u_n + s L_n >= t,  L_n >= 0,  L_n (u_n + s L_n - t) = 0,   |L_t| <= mu L_n, L_t against u_t
// G = J K^-1 J^T through the joint factorisation (eq. (63) with K for M), s softness, t target.
//
// Block Gauss-Seidel, each contact solved exactly for given others: open, stick, or slip along the direction c that its own slip
// then has (Newton on c, no trigonometry). It finds who is open, who sticks, who slips in a few sweeps, but closes in on the
// impulses slowly where light limbs are pressed between heavy things. So it alternates with Newton on all conditions at once
// (semi-smooth, after Alart and Curnier 1991), at full length: the best of some steps is kept, then more sweeps follow, along
// conjugate directions (conjugate_sweeps.cpp). Islands in which the two go round in circles, where limbs jam, are followed from
// smoothed conditions instead (smoothed_newton.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/solver/constraint.h"
#include "engine/solver/dense_system.h"
#include "engine/solver/elimination_order.h"
#include "engine/solver/response.h"

namespace engine {

struct SolveReport {
  int sweeps = 0;
  int newton_steps = 0;
  double residual = 0;  // [m/s] natural map, largest over the blocks
  int worst = -1;       // the constraint that has it, if the tolerance is not met
};

/// What an island is solved by first. Sweeps are where it is large: a small one costs Newton little.
enum class Begin { newton, sweeps };

class ContactSolver {
 public:
  /// Buffers for so many constraints, so that no step allocates.
  void reserve(const Topology&, std::size_t constraints);

  /// Builds G for the constraints named. Their rows and bodies must be set, and their bodies' trees factorised. `anew` (per tree):
  /// if the constraints are those of the last G, only these trees have been factorised since.
  void assemble(const Topology&, const Articulation&, const std::vector<Constraint>&, const std::vector<int>& members,
                const std::vector<char>* anew = nullptr);

  /// Solves; impulses of the constraints are start value and result, u_after is set. `tolerance` [m/s].
  SolveReport solve(std::vector<Constraint>&, const std::vector<int>& members, double tolerance, Begin = Begin::newton);

  /// Displaces along the normals alone, none pulled: G push + displacement wanted >= 0. Sets Constraint::push.
  void push_apart(std::vector<Constraint>&, const std::vector<int>& members, const std::vector<double>& wanted);

  /// Change of kinetic energy [J] by the impulses: L.u_after - 1/2 L.G L.
  double kinetic_energy_change(const std::vector<Constraint>&, const std::vector<int>& members) const;

 private:
  void note_own_responses(const std::vector<Constraint>&, const std::vector<int>& members);
  void soften_dead_centres(const std::vector<Constraint>&, const std::vector<int>& members);
  void add_to_velocity(int member, int rows, const Vec3& change);
  double sweep(std::vector<Constraint>&, const std::vector<int>& members);
  /// Residual [m/s] that is asked for, and one that will do.
  struct Aim {
    double wanted, tolerated;
  };
  void sweep_on(std::vector<Constraint>&, const std::vector<int>& members, Aim, int most, SolveReport&);
  double move_along(std::vector<Constraint>&, const std::vector<int>& members, double last);
  void iterate(std::vector<Constraint>&, const std::vector<int>& members, double tolerance, int sweeps, SolveReport&);
  void begin(std::vector<Constraint>&, const std::vector<int>& members, const std::vector<Vec3>& impulses);
  bool push_who_must(std::vector<Constraint>&, const std::vector<int>& members, const std::vector<double>& wanted, double tight);
  void solve_smoothed(std::vector<Constraint>&, const std::vector<int>& members, double tolerance, SolveReport&);
  void note_best(const std::vector<Constraint>&, const std::vector<int>& members);
  struct Miss {
    double residual = 0;
    int constraint = -1;
  };
  Miss largest_miss(const std::vector<Constraint>&, const std::vector<int>& members) const;
  double residual(const std::vector<Constraint>&, const std::vector<int>& members) const;
  /// What Newton takes care of: nothing, contacts more than the bodies have freedoms, chains of contacts that jam each other.
  enum class Care { none, redundant, jammed };
  bool newton(std::vector<Constraint>&, const std::vector<int>& members, Aim, Care, SolveReport&);
  bool newton_step(std::vector<Constraint>&, const std::vector<int>& members, bool again);
  void write_linearised(const std::vector<Constraint>&, const std::vector<int>& members);
  bool factor_linearised(const std::vector<Constraint>&, const std::vector<int>& members);
  void follow_smoothing(std::vector<Constraint>&, const std::vector<int>& members, double tolerance, double sharper, SolveReport&);
  bool smoothed_step(std::vector<Constraint>&, const std::vector<int>& members, double eps);
  void keep(const std::vector<Constraint>&, const std::vector<int>& members);
  void go_back(std::vector<Constraint>&, const std::vector<int>& members);
  int linearise(const std::vector<Constraint>&, const std::vector<int>& members);
  Vec3 velocity(int member, int rows) const;
  double G(int row, int column) const { return G_[static_cast<std::size_t>(column) * stride_ + static_cast<std::size_t>(row)]; }

  /// An unknown of Newton's and the condition that goes with it: an impulse along a row of G, or of a contact that slides its
  /// normal impulse with the friction it drags along, and its friction across.
  struct Row {
    enum Kind { normal, stick, sliding, across } kind;
    int member, r;
    bool operator==(const Row&) const = default;
  };
  /// Of a contact that slides; across its slip by_impulse L + by_velocity u = 0.
  struct Slip {
    Eigen::Vector2d along, across;
    double most;         // [N s] friction along
    double by_velocity;  // [-]
    double by_impulse;   // [1/kg]
  };
  static Slip slipping(const Constraint&, double rho, const Eigen::Vector2d& x);
  /// Rows of a column of G: `length` neighbours, or none and the weighed sum of two. They are `at` in the unknowns' column.
  struct Pick {
    int first, length, at;
    std::uint64_t trees;  // EliminationOrder::trees
    Eigen::Vector2d weights;
  };
  void choose_rows();
  void leave_zeros_out(std::uint64_t trees);
  void pick(const std::array<const double*, 2>& from, const std::array<double*, 2>& to) const;
  /// Of an unknown that slides, in all rows of G.
  struct Answer {
    std::vector<double> rows;  // stride_
    Rows reach;                // outside of it they are zero
  };
  const double* answer_of_slip(const Constraint&, const Row&, Answer&);
  void take_known(std::vector<Constraint>&, const std::vector<int>& members);

  double regular_ = 0;
  std::vector<double> softened_;  // [1/kg] per member: by which it answers more than its bodies do
  Response response_;
  int size_ = 0;
  std::size_t stride_ = 0;          // whole_rows(size_)
  std::vector<int> assembled_;      // members of the last G
  std::vector<int> offset_;         // per member
  AlignedVector G_;                 // column-major stride_ x size_
  std::vector<Mat3> own_;           // per member: its block on the diagonal; of one row the rest is a unit matrix
  AlignedVector u_;                 // stride_
  EliminationOrder elimination_;    // of the members in Newton's matrix
  DenseSystem newton_;              // of the rows that can change
  std::vector<int> unknown_;        // row of G per unknown
  std::vector<Row> rule_;           // per unknown
  std::vector<Row> factored_rule_;  // of the matrix in newton_
  std::vector<Slip> slips_;         // per member, of those that slide
  std::vector<int> opens_;          // members whose impulse goes to zero
  std::vector<Pick> picks_;         // of a column of G
  std::vector<int> met_picks_;      // those of them that the trees of the columns in hand have a part in
  std::array<Answer, 2> answers_;   // of two neighbours
  std::vector<double> L_, L_kept_;
  AlignedVector u_kept_;
  std::vector<double> L_along_, u_along_;  // the direction of conjugate sweeps
  std::vector<Vec3> L_start_, L_nothing_, L_best_;
};

}  // namespace engine
