// Vehicle against vehicle or barrier by Kudlich-Slibar, where both ask for it: the bodies run into each other unhindered for the
// time t_P from their first touch; then one impulse acts at the centroid of the overlap. If they still close at it another t_P
// later, or touch again after having parted, a further one does. Both instants are placed inside a step, so that a result does not
// hang on where its steps end.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/math/functions.h"
#include "engine/math/roots.h"
#include "engine/solver/kudlich_slibar.h"

namespace engine {
namespace {

constexpr double kSteep = 0.5;         // [-] cosine in plan below which a settled normal says little about left and right
constexpr double kSecondary = 0.1;     // [m/s] bodies that lie against each other and close slower have no further impact
constexpr double kTouchPlaced = 1e-6;  // [s] to which a touch is placed: micrometres of way
constexpr double kInterlocked = 0.6;   // [-] friction of crushed bodywork; SMAC has 0.55 (R. R. McHenry)
constexpr double kFacesMet = 0.15;     // [m] of way from the first touch, after which the plane of the faces shows
constexpr double kEarliest = 0.02;     // [s] a touch is looked for in the past at most, where the grid saw it late

/// Two meshes that collide by Kudlich-Slibar.
struct ImpactPair {
  int a = 0, b = 0;
  ImpactSettings settings;
};

std::vector<ImpactPair> pairs_of(const Model& model) {
  std::vector<ImpactPair> out;
  const int n = static_cast<int>(model.bodies.size());
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      const Body& A = model.bodies[a];
      const Body& B = model.bodies[b];
      if (!std::holds_alternative<MeshShape>(A.shape) || !std::holds_alternative<MeshShape>(B.shape)) continue;
      if (model_between(A.collision_model, B.collision_model) != CollisionModel::kudlich_slibar) continue;
      if ((A.fixed && B.fixed) || jointed(model, a, b)) continue;
      ImpactPair pair;
      pair.a = a;
      pair.b = b;
      for (const ImpactSettings& s : model.impacts)
        if ((s.body_a == a && s.body_b == b) || (s.body_a == b && s.body_b == a)) pair.settings = s;
      out.push_back(pair);
    }
  return out;
}

Finding look_for_kudlich_slibar(const Model& model) {
  std::vector<std::string> pairs;
  for (const ImpactPair& pair : pairs_of(model))
    pairs.push_back(model.bodies[pair.a].name + " with " + model.bodies[pair.b].name + " (exchange " +
                    number(1e3 * pair.settings.penetration_time) + " ms after the touch)");
  if (!pairs.empty()) return {true, "both ask for it: " + listed(pairs), "only meshes whose spheres are apart"};
  const auto meshes = std::count_if(model.bodies.begin(), model.bodies.end(), is_mesh);
  if (meshes == 0) return {false, "no vehicle and no other mesh", ""};
  if (meshes == 1) return {false, "one mesh alone", ""};
  const auto asking = static_cast<std::size_t>(std::count_if(model.bodies.begin(), model.bodies.end(), [](const Body& b) {
    return is_mesh(b) && b.collision_model == CollisionModel::kudlich_slibar;
  }));
  return {false,
          counted(asking, "mesh asks", "meshes ask") + " for it; it takes two that can meet, others meet by bodywork_contact", ""};
}

const MeshShape& mesh_of(const World& world, int body) {
  return std::get<MeshShape>(world.model.bodies[body].shape);
}

/// Pose of a body's mesh `ahead` [s] of the state, on at the velocity it has.
Pose mesh_pose(const World& world, const State& state, int body, double ahead) {
  const Twist& V = state.V_WB[body];
  Pose X = state.X_WB[body];
  X.p += ahead * V.v;
  if (const double w = V.w.norm(); w > 0) X.q = math::rotation(ahead * w, V.w / w) * X.q;
  return X * mesh_of(world, body).X_BM;
}

std::optional<MeshOverlap> overlap_at(const World& world, const State& state, const ImpactPair& pair, double ahead,
                                      OverlapScratch& scratch) {
  return overlap_of(*mesh_of(world, pair.a).mesh, mesh_pose(world, state, pair.a, ahead), *mesh_of(world, pair.b).mesh,
                    mesh_pose(world, state, pair.b, ahead), scratch);
}

/// When [s] from now the meshes of a pair begin to share space, which they do after `until` in `region`.
double touch_before(const World& world, const State& state, const ImpactPair& pair, double until, const PlanBox& region,
                    OverlapScratch& scratch) {
  const auto touch = [&](double ahead) {
    return share_space(*mesh_of(world, pair.a).mesh, mesh_pose(world, state, pair.a, ahead), *mesh_of(world, pair.b).mesh,
                       mesh_pose(world, state, pair.b, ahead), region, scratch);
  };
  double high = until, stride = world.model.settings.step, low = until - stride;
  while (low > -kEarliest && touch(low)) {
    high = low;
    stride *= 2;
    low -= stride;
  }
  return math::bisect({low, high}, math::kToTheWidth, kTouchPlaced, [&](double ahead) { return !touch(ahead); }).high;
}

/// Nowhere do the two move fast enough against each other for a further impact.
bool lie_together(const World& world, const State& state, const ImpactPair& pair) {
  const Twist &A = state.V_WB[pair.a], &B = state.V_WB[pair.b];
  return (A.v - B.v).norm() + A.w.norm() * world.reach[pair.a] + B.w.norm() * world.reach[pair.b] < kSecondary;
}

Vec3 velocity_at(const State& state, int body, const Vec3& point) {
  return state.V_WB[body].v + state.V_WB[body].w.cross(point - state.X_WB[body].p);
}

/// Change of velocity of all bodies by an impulse [N s] at a point, on a and opposite on b, through their joints.
class ImpulseThroughJoints {
 public:
  ImpulseThroughJoints(World& world, const State& state, int a, int b, const Vec3& point, std::vector<Vec6>& force,
                       std::vector<Vec6>& change)
      : world_(world), a_(a), b_(b), point_(point), state_(state), force_(force), change_(change) {
    for (const int body : {a, b}) {
      const int tree = world.topology.tree_of_body[body];
      if (tree < 0 || std::find(trees_.begin(), trees_.end(), tree) != trees_.end()) continue;
      trees_.push_back(tree);
      world.impulse.factor_unless_known(world.topology, tree, state.X_WB);
    }
  }
  void respond(const Vec3& impulse) {
    for (Vec6& f : force_) f.setZero();
    for (Vec6& c : change_) c.setZero();
    force_[a_] << impulse, (point_ - state_.X_WB[a_].p).cross(impulse);
    force_[b_] << -impulse, -(point_ - state_.X_WB[b_].p).cross(impulse);
    for (const int tree : trees_) world_.impulse.solve(world_.topology, tree, force_, change_, Articulation::Bias::zero);
  }
  Vec3 change_at(int body) const { return change_[body].head<3>() + change_[body].tail<3>().cross(point_ - state_.X_WB[body].p); }
  /// K: change of the relative velocity at the point by an impulse.
  Mat3 matrix() {
    Mat3 K;
    for (int k = 0; k < 3; ++k) {
      respond(Vec3::Unit(k));
      K.col(k) = change_at(a_) - change_at(b_);
    }
    return 0.5 * (K + K.transpose());
  }
  const SmallVector<int, 2>& trees() const { return trees_; }
  const Vec6& change(int body) const { return change_[body]; }

 private:
  World& world_;
  int a_, b_;
  Vec3 point_;
  const State& state_;
  SmallVector<int, 2> trees_;
  std::vector<Vec6>&force_, &change_;
};

/// Of the shared space [m], across its shorter side in plan.
double depth_of(const MeshOverlap& overlap) {
  const Vec3 size = overlap.region.box_P.upper - overlap.region.box_P.lower;
  return std::min(size.x(), size.y());
}

/// A settled normal has either sign: that of the overlap's, which is seen in plan; where it is steeper than that, the closing one.
Vec3 facing(const Vec3& normal, const MeshOverlap& overlap, const Vec3& u) {
  const double along = normal.dot(overlap.normal_W);
  const bool turned = std::abs(along) > kSteep ? along < 0 : normal.dot(u) > 0;
  return turned ? Vec3(-normal) : normal;
}

void record(World& world, const ImpactPair& pair, const State& state, const Vec3& point, const Vec3& normal,
            const PlaneImpact& impact, double closing, double friction) {
  ContactRecord c;
  c.shapes = {ShapeKind::mesh, ShapeKind::mesh};
  c.body_a = pair.a;
  c.body_b = pair.b;
  c.point = point;
  c.normal = normal;
  c.state = ContactState::impact;
  c.impulse = impact.impulse;
  c.normal_impulse = impact.impulse.dot(normal);
  c.tangential_impulse = (impact.impulse - c.normal_impulse * normal).norm();
  c.friction_limit = friction * c.normal_impulse;
  c.energy_lost = impact.energy_lost;
  c.exchange = true;
  c.begun = state.time;
  c.slip = (impact.u_after - impact.u_after.dot(normal) * normal).norm();
  world.log.exchanges.push_back(c);
  world.log.events.push_back({state.time, "impact", pair.a, pair.b, point, closing});
}

}  // namespace

/// How far a pair has got: apart, in touch until an impulse is due, or exchanged.
struct ImpactProgress {
  bool touching = false;
  double due = 0;  // [s] when the impulse is exchanged, while touching
  int exchanges = 0;
  Vec3 faces_W = Vec3::Zero();  // normal of the faces that met, from b to a; zero: not known

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.touching, s.due, s.exchanges, s.faces_W);
  }
};
struct ImpactMemory {
  std::vector<ImpactProgress> pairs;

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.pairs);
  }
};

class KudlichSlibar final : public EffectWith<ImpactMemory> {
 public:
  static constexpr const char* kName = "kudlich_slibar";
  static Finding look(const Model& model) { return look_for_kudlich_slibar(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.groups_are_simple ? reach.first_touch : 0; }

  KudlichSlibar(World& world, int self)
      : EffectWith(self), pairs_(pairs_of(world.model)), force_(world.model.bodies.size()), change_(force_) {
    reserve(overlap_);
    world.log.exchanges.reserve(kRoom);
  }

  void begin(World& world, State& state) override {
    world.log.acted[static_cast<std::size_t>(self_)].told = true;
    memory(state).pairs.resize(pairs_.size());
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      ImpactProgress& progress = memory(state).pairs[i];
      const auto overlap = overlap_at(world, state, pairs_[i], 0, overlap_);
      progress.touching = overlap.has_value();  // then they have met as the run begins
      if (overlap && state.time == 0) warn_of_overlap(world, pairs_[i].a, pairs_[i].b, -depth_of(*overlap));
      progress.due = state.time + pairs_[i].settings.penetration_time;
      if (!progress.touching) look_ahead(world, state, pairs_[i], progress);
    }
    mark_next(state);
  }

  void before_step(World& world, State& state, double) override {
    const double now = state.time + 1.01 * kSliver * world.model.settings.step;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      ImpactProgress& progress = memory(state).pairs[i];
      if (!progress.touching || now < progress.due) continue;
      const double t_P = pairs_[i].settings.penetration_time, later = t_P > 0 ? t_P : ImpactSettings{}.penetration_time;
      if (progress.exchanges > 0 && lie_together(world, state, pairs_[i])) {
        progress.due = state.time + later;
        continue;
      }
      const auto overlap = overlap_at(world, state, pairs_[i], 0, overlap_);
      progress.touching = overlap.has_value();
      if (!overlap) {
        if (progress.exchanges == 0) tell_of_none(world, pairs_[i]);
        continue;
      }
      world.log.note_reach(self_, state.time);
      exchange(world, state, pairs_[i], progress, *overlap);
      progress.due = state.time + later;
    }
  }

  void after_step(StepContext& step) override {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      ImpactProgress& progress = memory(step.state).pairs[i];
      if (!progress.touching) look_ahead(step.world, step.state, pairs_[i], progress);
    }
    mark_next(step.state);
  }

 private:
  /// A touch within the step to come.
  void look_ahead(const World& world, const State& state, const ImpactPair& pair, ImpactProgress& progress) {
    const double step = world.model.settings.step;
    const Vec3 apart = state.X_WB[pair.a].p - state.X_WB[pair.b].p;
    const double closing = (state.V_WB[pair.a].v - state.V_WB[pair.b].v).norm();
    if (apart.norm() > world.reach[pair.a] + world.reach[pair.b] + closing * step) return;
    const auto overlap = overlap_at(world, state, pair, step, overlap_);
    if (!overlap) return;
    progress.touching = true;
    const double touch = touch_before(world, state, pair, step, overlap->region, overlap_);
    progress.faces_W = faces_met(world, state, pair, touch, overlap->centroid);
    progress.due = state.time + touch + penetration(world, state, pair, progress, touch);
  }

  /// Normal of the line in which the surfaces cut once the faces have met. Later it turns to the diagonal of the overlap, which is
  /// no face of either: two cars a metre in each other on 40 % of their widths would meet 60 degrees from square, and slide off.
  Vec3 faces_met(const World& world, const State& state, const ImpactPair& pair, double touch, const Vec3& point) {
    const double closing = (velocity_at(state, pair.a, point) - velocity_at(state, pair.b, point)).norm();
    const double after = std::min(kFacesMet / closing, ImpactSettings{}.penetration_time);
    const auto overlap = overlap_at(world, state, pair, touch + after, overlap_);
    return overlap ? overlap->normal_W : Vec3(Vec3::Zero());
  }

  /// The contact plane's normal: of the first impulse as the scene says; of the first of any touch by the faces that met; of those
  /// that follow as the two overlap.
  static Vec3 plane(const ImpactPair& pair, const ImpactProgress& progress, const MeshOverlap& overlap, const Vec3& u) {
    if (progress.exchanges == 0 && pair.settings.normal_W) return facing(*pair.settings.normal_W, overlap, u);
    return progress.faces_W.isZero() ? overlap.normal_W : progress.faces_W;
  }

  /// Time [s] from the touch to the impulse: as the scene says, or by halves less where the two would then be past each other, or
  /// part already by the normal of the plane they meet on.
  double penetration(const World& world, const State& state, const ImpactPair& pair, const ImpactProgress& progress, double touch) {
    constexpr int kHalves = 4;
    const double whole = pair.settings.penetration_time;
    for (double time = whole; time > whole / (1 << kHalves); time /= 2) {
      const double ahead = touch + time;
      const auto overlap = overlap_at(world, state, pair, ahead, overlap_);
      if (!overlap) continue;
      const Vec3 point = pair.settings.point_W.value_or(overlap->centroid);
      const auto velocity = [&](int body) { return velocity_at(state, body, point - ahead * state.V_WB[body].v); };
      const Vec3 u = velocity(pair.a) - velocity(pair.b);
      if (u.dot(plane(pair, progress, *overlap, u)) <= 0) return time;
    }
    return whole;
  }

  static void tell_of_none(World& world, const ImpactPair& pair) {
    const std::string text =
        world.model.bodies[pair.a].name + " and " + world.model.bodies[pair.b].name +
        " touched and parted before kudlich_slibar exchanged an impulse; collision = \"default_auto\" has their contact";
    auto& warnings = world.log.diagnostics.warnings;
    if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) warnings.push_back(text);
  }

  void mark_next(State& state) const {
    double next = std::numeric_limits<double>::infinity();
    for (const ImpactProgress& progress : memory(state).pairs)
      if (progress.touching) next = std::min(next, progress.due);
    state.pace.next_instant = next;
  }

  void exchange(World& world, State& state, const ImpactPair& pair, ImpactProgress& progress, const MeshOverlap& overlap) {
    const bool first = progress.exchanges == 0;
    const Vec3 point = first ? pair.settings.point_W.value_or(overlap.centroid) : overlap.centroid;
    const Vec3 u = velocity_at(state, pair.a, point) - velocity_at(state, pair.b, point);
    const Vec3 normal = plane(pair, progress, overlap, u);
    if (first && u.dot(normal) > 0) tell_of_none(world, pair);
    if (u.dot(normal) > (first ? 0 : -kSecondary)) return;

    const SurfacePairing surfaces = mixed_surfaces(world.model, pair.a, pair.b, point, state.time);
    const double mu = pair.settings.friction.value_or(std::max(kInterlocked, surfaces.friction));
    const double e = pair.settings.restitution.value_or(surfaces.restitution);
    ImpulseThroughJoints through(world, state, pair.a, pair.b, point, force_, change_);
    const PlaneImpact impact = kudlich_slibar(through.matrix(), u, normal, mu, e);
    through.respond(impact.impulse);
    for (const int tree : through.trees())
      for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
        const int body = world.topology.links[l].body;
        state.V_WB[body].v += through.change(body).head<3>();
        state.V_WB[body].w += through.change(body).tail<3>();
      }
    state.energy.dissipated[self_] += impact.energy_lost;
    record(world, pair, state, point, normal, impact, -u.dot(normal), mu);
    world.log.note_action(self_, state.time);
    ++progress.exchanges;
    progress.faces_W.setZero();
  }

  const std::vector<ImpactPair> pairs_;
  OverlapScratch overlap_;
  std::vector<Vec6> force_, change_;  // per body, of an impulse between two
};
template struct Registered<KudlichSlibar>;

}  // namespace engine
