#include "engine/measure/passage.h"

#include <cmath>
#include <set>
#include <utility>

#include "engine/geometry/hyper_ellipsoid.h"

namespace engine {
namespace {

struct Passage {
  double time = 0;  // [s]
  int object = -1;  // body
};

std::optional<Passage> passage_of(const Model& model, const Recording& recording, int vehicle) {
  const int body = model.vehicles[static_cast<std::size_t>(vehicle)].body;
  if (!yields(model.settings.contact_law, false)) return std::nullopt;
  std::set<int> struck;
  for (const Snapshot& s : recording.snapshots) {
    for (const ContactRecord& c : s.contacts)
      if (c.body_b >= 0 && (c.body_a == body || c.body_b == body)) struck.insert(c.body_a == body ? c.body_b : c.body_a);
    for (const int other : struck) {
      const Body& object = model.bodies[static_cast<std::size_t>(other)];
      const auto* shape = std::get_if<HyperEllipsoid>(&object.shape);
      if (!shape || object.person >= 0) continue;
      const Vec3 centre =
          s.bodies[static_cast<std::size_t>(other)].X_WB.inverse() * s.bodies[static_cast<std::size_t>(body)].X_WB.p;
      if (gauge(*shape, centre) < 1) return Passage{s.time, other};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> went_through(const Model& model, const Recording& recording, int vehicle) {
  const auto passage = passage_of(model, recording, vehicle);
  return passage ? std::optional(passage->time) : std::nullopt;
}

std::vector<std::string> passages(const Model& model, const Recording& recording) {
  std::vector<std::string> out;
  for (int v = 0; v < static_cast<int>(model.vehicles.size()); ++v)
    if (const auto passage = passage_of(model, recording, v))
      out.push_back(
          model.vehicles[static_cast<std::size_t>(v)].name + " went into " +
          model.bodies[static_cast<std::size_t>(passage->object)].name + " as deep as its centre of mass at " +
          std::to_string(std::lround(1e3 * passage->time)) +
          " ms, farther than any vehicle gives way: do not rely on motion from there on; more stiffness may hold it out, or "
          "contact_law = \"default_auto\"");
  return out;
}

}  // namespace engine
