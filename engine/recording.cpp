#include "engine/recording.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "engine/contact/pair_table.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

struct Fnv {
  std::uint64_t value = 1469598103934665603ull;
  void add(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    for (int i = 0; i < 8; ++i) value = (value ^ ((bits >> (8 * i)) & 0xff)) * 1099511628211ull;
  }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
};

/// Cubic through two places with their velocities.
Vec3 hermite(const Vec3& p0, const Vec3& v0, const Vec3& p1, const Vec3& v1, double interval, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * interval * v0 + (-2 * s3 + 3 * s2) * p1 + (s3 - s2) * interval * v1;
}

/// When [s] between two snapshots an impact at an instant changed the velocity of a body, by the contacts of the later one: half
/// way it would have a speed that it never had. What pushes for a while, or pulls at a joint, changes it little by little.
std::optional<double> struck_at(const Snapshot& before, const Snapshot& later, int body) {
  constexpr double kChange = 0.8 / 3.6;  // [m/s] as collision phases are counted
  const auto velocity = [&](const Snapshot& s) { return s.bodies[static_cast<std::size_t>(body)].V_WB.v; };
  if ((velocity(later) - velocity(before)).norm() < kChange) return std::nullopt;
  std::optional<double> out;
  for (const ContactRecord& c : later.contacts) {
    const bool at_once = c.exchange || c.state == ContactState::impact;
    if (at_once && (c.body_a == body || c.body_b == body) && c.begun > before.time)
      out = std::min(out.value_or(later.time), c.begun);
  }
  return out;
}

}  // namespace

const char* name_of(const ShapePair& shapes) {
  return pair_kind(shapes).name;
}

const char* name_of(ContactState state) {
  switch (state) {
    case ContactState::approach:
      return "approach";
    case ContactState::separate:
      return "separate";
    case ContactState::slide:
      return "slide";
    case ContactState::stick:
      return "stick";
    case ContactState::impact:
      return "impact";
  }
  return "";
}

std::vector<BodyState>& BodyStates::own() {
  if (!still_) return others_;
  std::vector<BodyState> all;
  all.reserve(size());
  for (const BodyState& state : *this) all.push_back(state);
  still_ = nullptr;
  return others_ = std::move(all);
}

Snapshot Recording::at(double time) const {
  if (time <= snapshots.front().time) return snapshots.front();
  if (time >= snapshots.back().time) return snapshots.back();
  // a time that was reckoned may fall a rounding behind the snapshot it means, and must not show the contacts of the one after
  const double rounding = 1e-9 * interval;
  const auto later =
      std::lower_bound(snapshots.begin(), snapshots.end(), time - rounding, [](const Snapshot& s, double t) { return s.time < t; });
  if (later->time <= time) return *later;
  const Snapshot& a = *(later - 1);
  Snapshot out = *later;
  const double span = later->time - a.time;
  const double s = (time - a.time) / span;
  out.time = time;
  std::vector<BodyState>& between = out.bodies.own();
  for (std::size_t b = 0; b < between.size(); ++b) {
    const BodyState& from = a.bodies[b];
    const BodyState& to = later->bodies[b];
    between[b].X_WB.p = hermite(from.X_WB.p, from.V_WB.v, to.X_WB.p, to.V_WB.v, span, s);
    between[b].X_WB.q = math::slerp(from.X_WB.q, to.X_WB.q, s);
    if (const auto struck = struck_at(a, *later, static_cast<int>(b))) {
      between[b].V_WB = time < *struck ? from.V_WB : to.V_WB;
      continue;
    }
    between[b].V_WB.v = (1 - s) * from.V_WB.v + s * to.V_WB.v;
    between[b].V_WB.w = (1 - s) * from.V_WB.w + s * to.V_WB.w;
  }
  for (std::size_t w = 0; w < out.wheels.size() && w < a.wheels.size(); ++w) {
    WheelRecord& r = out.wheels[w];
    r.hub = (1 - s) * a.wheels[w].hub + s * r.hub;
    r.contact = (1 - s) * a.wheels[w].contact + s * r.contact;
    r.steer = (1 - s) * a.wheels[w].steer + s * r.steer;
    r.spin = (1 - s) * a.wheels[w].spin + s * r.spin;
  }
  return out;
}

std::uint64_t hash(const Recording& recording) {
  Fnv fnv;
  for (const Snapshot& s : recording.snapshots) {
    fnv.add(s.time);
    for (const BodyState& b : s.bodies) {
      fnv.add(b.X_WB.p);
      for (int i = 0; i < 4; ++i) fnv.add(b.X_WB.q.coeffs()[i]);
      fnv.add(b.V_WB.v);
      fnv.add(b.V_WB.w);
    }
    for (const ContactRecord& c : s.contacts) {
      fnv.add(c.point);
      fnv.add(c.normal_impulse);
      fnv.add(c.tangential_impulse);
    }
  }
  return fnv.value;
}

}  // namespace engine
