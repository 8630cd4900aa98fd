// Who takes part in an accident, as measures count them: a vehicle, a person with all its parts, a free body.
#pragma once

#include <optional>
#include <vector>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

/// One of them; `bodies` are those whose masses and motions are its own. What a person rides is a vehicle by itself.
struct Party {
  int person = -1;
  int vehicle = -1;
  std::vector<int> bodies;  // root first
};

/// The party a body belongs to; the body alone where it is nobody's part.
Party party_of(const Model&, int body);

bool holds(const Party&, int body);

bool is_two_wheeler(const Model&, const Party&);

double mass_of(const Model&, const Party&);
Vec3 centre_of_mass(const Model&, const Party&, const Snapshot&);
Vec3 velocity_of(const Model&, const Party&, const Snapshot&);

/// Hips, head and the parts that join them; of a person without a head hips and torso.
std::vector<int> trunk_of(const Model&, int person);

/// Per body: is it of a person's trunk?
std::vector<char> trunks_of(const Model&);

/// The bodies given and all that are joined to them for good, as a trailer to what tows it.
std::vector<int> joined_for_good(const Model&, std::vector<int> bodies);

/// When [s] the last joint between the two broke; the end of the run where one holds, nothing where there never was one.
std::optional<double> joined_until(const Model&, const Recording&, const Party&, const Party&);

/// When it came to rest for good, if it did within the run: its own bodies, not what it rode or what rode it.
/// A person rests with its trunk.
std::optional<double> rest_of(const Model&, const Recording&, const Party&);

/// The last recorded instant that is not after `time`: what an impact at that time found. A state between two instants holds part
/// of what the impact did.
const Snapshot& found_at(const Recording&, double time);

/// A wall, a kerb, a pavement: a body that is fixed and no vehicle. It strikes nobody on foot, and to come down on it is to land.
bool is_fixture(const Model&, int body);

/// Whether a surface with this unit normal, away from it, is one to stand or lie on and no wall.
inline bool bears(const Vec3& normal) {
  return normal.z() > 0.5;
}

/// Whether a touch between such shapes, of that body with that unit normal away from it, is one of the ground or of what stands on
/// it for good, whatever its shape.
inline bool is_ground(const Model& model, const ShapePair& shapes, int body, const Vec3& normal) {
  return shapes.on_ground() || (is_fixture(model, body) && bears(normal));
}

/// A push of a contact on the party, zero where it has no part in it; contacts within the party count for nothing.
Vec3 push_on(const Party&, const ContactRecord&);

}  // namespace engine
