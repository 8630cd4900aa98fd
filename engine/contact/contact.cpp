#include "engine/contact/contact.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "engine/contact/ploughing.h"
#include "engine/contact/round_tyre.h"
#include "engine/laws/compliant_contact.h"
#include "engine/world.h"

namespace engine {

SurfacePairing mixed_surfaces(const Model& model, int a, int b, const Vec3& point, double time) {
  const SurfaceProperties& A = model.bodies[a].surface;
  if (b < 0)
    return {std::min(A.friction_ground.at(time), model.ground.friction_at(point, time)),
            std::max(A.restitution_ground.at(time), model.ground.surface.restitution_ground.at(time))};
  const SurfaceProperties& B = model.bodies[b].surface;
  return {std::min(A.friction_body.at(time), B.friction_body.at(time)),
          std::max(A.restitution_body.at(time), B.restitution_body.at(time))};
}

namespace {

/// Rows of a body at a contact point, with the sign of its side.
Eigen::Matrix<double, 3, 6> contact_rows(const Constraint& c, const Pose& X_WB, double sign) {
  Eigen::Matrix<double, 3, 6> J;
  const Vec3 r = c.point - X_WB.p;
  for (int k = 0; k < 3; ++k) {
    const Vec3 d = sign * c.frame.col(k);
    J.row(k) << d.transpose(), r.cross(d).transpose();
  }
  return J;
}

bool is_head(const Model& model, int body) {
  return is_part(model, body) && model.persons[model.bodies[body].person].head == body;
}

/// What a part of a person meets of a vehicle.
std::optional<Panel> panel_met(const Model& model, const Motion& at, const SurfaceContact& touch, int a, int b) {
  const auto* mesh = is_part(model, a) && b >= 0 ? std::get_if<MeshShape>(&model.bodies[b].shape) : nullptr;
  if (!mesh || !mesh->panels) return std::nullopt;
  const Pose X_MW = (at.X_WB[b] * mesh->X_BM).inverse();
  return panel_at(*mesh->mesh, *mesh->panels, X_MW * touch.p_b, X_MW.q * touch.normal);
}

/// S of both surfaces [N/m]. To a person a vehicle is what the panel it meets is, unless the scene gives a stiffness of its own.
std::pair<double, double> stiffnesses(const Model& model, double time, const std::optional<Panel>& panel, int a, int b) {
  const auto surface = [&](int body) -> const SurfaceProperties& {
    return body >= 0 ? model.bodies[body].surface : model.ground.surface;
  };
  const auto own = [&](int body) { return surface(body).stiffness.at(time); };
  return {own(a), panel && !surface(b).stiffness_given ? stiffness_of(*panel) : own(b)};
}

/// Does a body on a mesh stay on the side it came from, however deep? Walls and poles do, where bodywork alone gives way for them.
bool held_from_its_side(const Model& model, int body) {
  return model.settings.contact_law == ContactLaw::compliant && !is_part(model, body);
}

/// Both surfaces of a compliant contact as springs in series. They share the depth by depth_a S_a = depth_b S_b, eq. (81). What a
/// head presses into a panel that has yielded, the panel alone gives way by.
void set_stiffness(Constraint& c, const Model& model, double time, const std::optional<Panel>& panel, double depth) {
  const auto [S_a, S_b] = stiffnesses(model, time, panel, c.a.record, c.b.record);
  c.spring.stiffness = stiffness_in_series(S_a, S_b);
  c.spring.hysteresis = c.surface.restitution;
  c.surface.restitution = 0;
  c.spring.share_a = S_b / (S_a + S_b);
  if (panel) c.spring.loading = c.spring.stiffness;
  if (panel && !model.bodies[c.b.record].surface.stiffness_given && is_head(model, c.a.record)) c.spring.yield = yield_of(*panel);
  if (c.spring.stiffness * depth > c.spring.yield) {
    c.spring.stiffness = c.spring.yield / depth;
    c.spring.share_a = c.spring.stiffness / S_a;
  }
  if (c.b.record >= 0 && is_mesh(model.bodies[c.b.record]) && held_from_its_side(model, c.a.record)) return;
  for (const int body : {c.a.record, c.b.record})
    if (const auto* shape = body >= 0 ? std::get_if<HyperEllipsoid>(&model.bodies[body].shape) : nullptr)
      c.spring.thickness = std::min(c.spring.thickness, 2 * shape->semi_axes.minCoeff());
}

/// Velocity [m/s] of body a against body b at a point.
Vec3 relative_velocity(const Motion& at, int a, int b, const Vec3& point) {
  const auto velocity = [&](int body) -> Vec3 { return at.V_WB[body].v + at.V_WB[body].w.cross(point - at.X_WB[body].p); };
  return velocity(a) - velocity(b);
}

/// A part that comes from one panel onto another takes its force along. The new one resists as far as the part has gone into it,
/// from above or sideways: it has not been pressed in by all of the depth yet. By its depth alone a head 14 cm deep in a pane,
/// where it had 3.5 kN, would get 40 kN at once from the pillar beside it. Only where persons alone yield.
void carry_force_over(Constraint& c, const ContactSearch& search, const SurfaceContact& touch) {
  constexpr double kAll = 1 - 1e-9;  // [-] short of it by rounding alone
  const double depth = -touch.gap, alone = c.spring.stiffness * depth;
  c.spring.force = alone;
  if (search.world.model.settings.contact_law != ContactLaw::persons_yield) return;
  const Constraint* last = nullptr;  // on the same panel, or else the deepest
  bool same = false;
  for (const Constraint& b : search.before) {
    if (b.a.record != c.a.record || b.b.record != c.b.record || b.spring.force <= 0) continue;
    const bool on_it = b.spring.loading == c.spring.loading;
    if (last && (on_it == same ? b.gap >= last->gap : same)) continue;
    last = &b;
    same = on_it;
  }
  if (!last || (same && last->spring.reached == 1)) return;
  const Vec3 u = relative_velocity(search.at, c.a.record, c.b.record, touch.p_b);
  const double deeper = depth + last->gap;
  const double aside = (u - u.dot(touch.normal) * touch.normal).norm() * (search.at.time - search.state.time);
  const double carried =
      same && deeper < 0 ? last->spring.reached * alone : last->spring.force + c.spring.loading * std::max(0.0, deeper);
  const double force = carried + c.spring.loading * aside;
  if (force >= kAll * alone) return;
  c.spring.force = force;
  c.spring.reached = force / alone;
  c.spring.stiffness *= c.spring.reached;
  c.spring.share_a *= c.spring.reached;
}

/// Half of the thinner part along the normal is what the two can give way by; into a panel a little less than by which the
/// part's centre may pass: three quarters of a head's half thickness into sheet metal, which has something behind it, and all of
/// it into a pane, which has not until the head is through. Only where persons alone yield.
void set_room(Constraint& c, const World& world, const Motion& at, const SurfaceContact& touch, const std::optional<Panel>& panel) {
  constexpr double kIntoMetal = 0.75;  // [-] of the half thickness
  if (world.model.settings.contact_law != ContactLaw::persons_yield) return;
  c.spring.room = std::numeric_limits<double>::infinity();
  const auto is_round_part = [&](int body) {
    return is_part(world.model, body) && std::holds_alternative<HyperEllipsoid>(world.model.bodies[body].shape);
  };
  const Vec3& n = touch.normal;
  if (is_round_part(c.a.record)) c.spring.room = std::min(c.spring.room, n.dot(at.X_WB[c.a.record].p - touch.p_a));
  if (is_round_part(c.b.record)) c.spring.room = std::min(c.spring.room, n.dot(touch.p_b - at.X_WB[c.b.record].p));
  if (c.shapes.on_vehicle()) {
    const double most = may_pass(world.model, c.a.record);
    c.spring.room *= 0.9 * (1 + (panel && is_glass(*panel) ? most : std::min(most, kIntoMetal)));
  }
  c.spring.struck_mass = 1 / c.response.free;
}

/// A part that lies in a dent of bodywork, which is the panel's share of the depth. It has gone through once all of it, as it lies,
/// is within. Only where persons alone yield.
void set_ploughing(Constraint& c, const World& world, const Motion& at, const SurfaceContact& touch) {
  constexpr double kSlips = 1e-6;  // [m/s]
  const Model& model = world.model;
  if (model.settings.contact_law != ContactLaw::persons_yield || !is_part(model, c.a.record) || c.b.record < 0 || c.gap >= 0)
    return;
  const auto* part = std::get_if<HyperEllipsoid>(&model.bodies[c.a.record].shape);
  const auto* mesh = std::get_if<MeshShape>(&model.bodies[c.b.record].shape);
  if (!part || !mesh || !mesh->panels || c.shapes.b != ShapeKind::mesh) return;
  const Vec3 normal = c.frame.col(0), u = relative_velocity(at, c.a.record, c.b.record, c.point), slip = u - u.dot(normal) * normal;
  const Vec3 along = slip.norm() > kSlips ? Vec3(slip.normalized()) : Vec3(c.frame.col(1));
  const Pose& X_WB = at.X_WB[c.a.record];
  const Quat q_BW = X_WB.q.conjugate();
  c.spring.thickness = 2 * normal.dot(X_WB.p - touch.p_a);
  c.surface.ploughing = (1 - c.spring.hysteresis) * ploughing(*part, q_BW * normal, q_BW * along, (c.spring.share_a - 1) * c.gap);
  c.surface.friction += c.surface.ploughing;
}

/// How the contact's bodies answer an impulse were they free, and were all that hangs on them one piece.
void set_responses(Constraint& c, const World& world) {
  int last_tree = -1;
  for (const int body : {c.a.body, c.b.body}) {
    if (body < 0) continue;
    c.response.free += 1 / world.model.bodies[body].mass;
    const int tree = world.topology.tree_of_body[body];
    if (tree != last_tree) c.response.whole += 1 / world.tree_mass[tree];
    last_tree = tree;
  }
}

std::uint64_t key_of(const SurfaceContact& touch, int a, int b, int effect) {
  return (static_cast<std::uint64_t>(effect) << 56) | (static_cast<std::uint64_t>(a & 0xffff) << 40) |
         (static_cast<std::uint64_t>(b & 0xffff) << 24) | (touch.key & 0xffffffu);
}

/// The tread of a wheel that turns runs down in front of it, and pulls what it meets beneath it. What that asks of the wheel the
/// road gives back, by the same rows.
void set_rim(Constraint& c, const ContactSearch& search, const TyrePair& pair) {
  if (is_part(search.world.model, c.a.record))  // clothes hold rubber as they hold a road; bodywork they slide on
    c.surface.friction = search.world.model.bodies[c.a.record].surface.friction_ground.at(search.at.time);
  if (search.state.wheels[pair.wheel].locked || c.b.body < 0) return;
  const RollingRim rim = rim_at(search, pair, c.point);
  for (int k = 1; k < 3; ++k) c.b.J.row(k) -= c.frame.col(k).dot(rim.way) * rim.roll;
  c.surface.held = rim.grip;
  c.surface.friction = std::min(c.surface.friction, rim.grip);
}

/// The contact at one point.
void add_contact(ContactSearch& search, const PairKind& kind, const SurfaceContact& touch, const ContactPair& pair, int effect) {
  const World& world = search.world;
  const int a = pair.a, b = std::max(pair.b, -1);
  const bool on_tyre = kind.shapes.a == ShapeKind::round && kind.shapes.b == ShapeKind::tyre;
  const SurfacePairing surfaces = mixed_surfaces(world.model, a, b, touch.p_b, search.at.time);
  Constraint& c = search.found.emplace_back();  // filled where it stays: it is long
  c.kind = ConstraintKind::contact;
  c.rows = 3;
  set_bodies(c, world.model, a, b);
  if (c.a.body < 0 && c.b.body < 0) return search.found.pop_back();
  c.surface.rolls = touch.rolls;
  c.surface.friction = c.surface.rolls ? 0 : surfaces.friction;
  c.surface.restitution = surfaces.restitution;
  const bool compliant = yields_between(world.model, a, b);
  const std::optional<Panel> panel = compliant ? panel_met(world.model, search.at, touch, a, b) : std::nullopt;
  if (compliant) set_stiffness(c, world.model, search.at.time, panel, -touch.gap);
  if (panel && touch.gap < 0) carry_force_over(c, search, touch);
  const Vec3 way = touch.p_b - touch.p_a, along = way.dot(touch.normal) * touch.normal;
  c.point = touch.p_a + c.spring.share_a * along + touch.share_across * (way - along);
  const Vec3 t1 = touch.normal.unitOrthogonal();
  c.frame << touch.normal, t1, touch.normal.cross(t1);
  if (c.a.body >= 0) c.a.J = contact_rows(c, search.at.X_WB[c.a.body], 1);
  if (c.b.body >= 0) c.b.J = contact_rows(c, search.at.X_WB[c.b.body], -1);
  if (on_tyre) set_rim(c, search, world.pairs.tyres[pair.at]);
  set_responses(c, world);
  // rigid, what rests would sink by as much before its corners carried; what yields sinks by its load
  c.gap = compliant ? touch.gap : touch.gap - touch.lifted;
  c.key = key_of(touch, a, b, effect);
  c.effect = effect;
  c.shapes = kind.shapes;
  if (compliant) set_room(c, world, search.at, touch, panel);
  if (compliant) set_ploughing(c, world, search.at, touch);
}

/// Compliant law: the points appended from `first` on, all of one surface on another, share its stiffness S by depth, so that a
/// face that stands on four corners, or a limb on many small triangles, yields as one that touches at one point: S_i = S d_i /
/// sum_j d_j max(0, n_i.n_j). Points that face different ways do not share.
void share_stiffness(ContactSearch& search, std::size_t first) {
  constexpr double kLeast = 1e-6;  // [m] what hardly touches has hardly a share
  std::vector<Constraint>& all = search.found;
  if (all.size() < first + 2 || !is_compliant(all[first])) return;
  for (std::size_t i = first; i < all.size(); ++i) {
    double sum = 0;
    for (std::size_t j = first; j < all.size(); ++j)
      sum += std::max(-all[j].gap, kLeast) * std::max(0.0, all[i].frame.col(0).dot(all[j].frame.col(0)));
    const double share = std::max(-all[i].gap, kLeast) / sum;
    all[i].spring.stiffness *= share;
    all[i].spring.yield *= share;
    all[i].spring.struck_mass *= share;
  }
}

}  // namespace

double may_pass(const Model& model, int body) {
  if (held_from_its_side(model, body)) return std::numeric_limits<double>::infinity();
  const bool into_panel = model.settings.contact_law == ContactLaw::persons_yield && is_head(model, body);
  return into_panel ? 1.0 : 0.25;
}

void add_contacts(ContactSearch& search, const PairKind& kind, const ContactPair& pair, int effect) {
  const World& world = search.world;
  const auto frozen = [&world](int body) { return body >= 0 && !world.awake[body] && !world.model.bodies[body].fixed; };
  if (frozen(pair.a) || frozen(pair.b)) return;
  const std::size_t first = search.found.size();
  for (const SurfaceContact& touch : kind.touches(search, pair)) add_contact(search, kind, touch, pair, effect);
  if (kind.one_patch) share_stiffness(search, first);
}

}  // namespace engine
