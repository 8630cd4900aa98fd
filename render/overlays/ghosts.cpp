// Stroboscopic figures: where persons, with what they ride, and free bodies were, at equal times or equal distances, pale against
// what is there now.
#include <algorithm>

#include "render/matrix.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr std::size_t kMost = 60;  // figures of one person: more are a smear
constexpr float kPale = 0.55f;     // [-] share of white paper in a ghost's colour
constexpr double kClear = 0.12;    // [m] a ghost nearer than this to the present figure only thickens it

Material pale(Material m) {
  for (float& c : m.colour) c = (1 - kPale) * c + kPale * 0.75f;
  m.kind = MaterialKind::matte;
  return m;
}

/// Instants before now at which `body` leaves a ghost.
std::vector<const engine::Snapshot*> instants(const Frame& frame, int body) {
  const double interval = frame.stage.overlays.of("ghost_interval"), distance = frame.stage.overlays.of("ghost_distance");
  const auto b = static_cast<std::size_t>(body);
  const Vec3 here = frame.now.bodies[b].X_WB.p;
  std::vector<const engine::Snapshot*> out;
  double travelled = 0, due_distance = 0, due_time = 0;
  const engine::Snapshot* before = nullptr;
  for (const engine::Snapshot& s : frame.recording.snapshots) {
    if (s.time > frame.now.time || out.size() == kMost) break;
    if (before) travelled += (s.bodies[b].X_WB.p - before->bodies[b].X_WB.p).norm();
    before = &s;
    const bool due = (interval > 0 && s.time >= due_time - 1e-9) || (distance > 0 && travelled >= due_distance);
    if (!due) continue;
    if (interval > 0) due_time += interval;
    if (distance > 0) due_distance = travelled + distance;
    if ((s.bodies[b].X_WB.p - here).norm() > kClear) out.push_back(&s);
  }
  return out;
}

void add_shape(DrawList& list, const engine::HyperEllipsoid& shape, const Pose& X, const Material& material) {
  list.ellipsoids.push_back({shape, to_gl(rigid(X)), pale(material), false, static_cast<std::uint32_t>(list.ellipsoids.size())});
}

/// Until a rider has left the saddle, what it rides moves with it.
void add_mount(const Frame& frame, const PersonActor& person, const engine::Snapshot& s, DrawList& list) {
  constexpr double kLeft = 0.3;  // [m]
  const auto seat = [&](const engine::Snapshot& at) -> Vec3 {
    const auto pose = [&](int body) -> const Pose& { return at.bodies[static_cast<std::size_t>(body)].X_WB; };
    return pose(person.mount).inverse() * pose(person.segments.front().body).p;
  };
  if (person.mount < 0 || (seat(s) - seat(frame.recording.snapshots.front())).norm() > kLeft) return;
  for (const MeshActor& actor : standing(frame.stage, person.mount, s)) {
    list.meshes.push_back(placed(actor.mesh, actor.X_BM, actor.repaint));
    for (Material& m : list.meshes.back().materials) m = pale(m);
  }
}

void add_ghosts(const Frame& frame, DrawList& list) {
  for (const PersonActor& person : frame.stage.persons) {
    if (person.segments.empty()) continue;
    const std::vector<const engine::Snapshot*> when = instants(frame, person.segments.front().body);
    for (const engine::Snapshot* s : when) add_mount(frame, person, *s, list);
    if (person.look == PersonLook::skin) {
      for (const engine::Snapshot* s : when) {
        list.skins.push_back(bent_skin(person, *s));
        for (const Material& m : list.skins.back().topology->materials) list.skins.back().materials.push_back(pale(m));
      }
      continue;
    }
    for (const engine::Snapshot* s : when)
      for (const PersonActor::Segment& segment : person.segments)
        add_shape(list, segment.shape, s->bodies[static_cast<std::size_t>(segment.body)].X_WB, segment.material);
  }
  for (const EllipsoidActor& actor : frame.stage.ellipsoids)
    for (const engine::Snapshot* s : instants(frame, actor.body))
      add_shape(list, actor.shape, s->bodies[static_cast<std::size_t>(actor.body)].X_WB, actor.material);
}

}  // namespace

struct Ghosts {
  static constexpr OverlayKey kKeys[] = {
      {"ghost_interval", 0, "Pale figures of persons, with what they ride, and of free bodies at equal times.", "s", 0.005, 60},
      {"ghost_distance", 0, "Pale figures at equal distances travelled.", "m", 0.02, 1000}};
  static constexpr Overlay kOverlay{"ghosts", kKeys, add_ghosts, [](const Frame& f) {
                                      return f.stage.overlays.on("ghost_interval") || f.stage.overlays.on("ghost_distance");
                                    }};
};
template struct Drawn<Ghosts>;

}  // namespace render
