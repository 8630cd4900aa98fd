#include "engine/measure/flung.h"

#include <algorithm>
#include <cmath>

namespace engine {
namespace {

// What a limb gets of a vehicle that goes at v: 2 v of a blow that gives all back, and half as much of its own swing about the
// trunk; 5 m/s of a fall beside it.
constexpr double kTimes = 2.5, kBeside = 5;  // [-], [m/s]

std::string with_one_digit(double value) {
  std::string out = std::to_string(std::lround(10 * value));
  if (out.size() < 2) out.insert(0, "0");
  return out.insert(out.size() - 1, ".");
}

}  // namespace

std::vector<std::string> flung_parts(const Model& model, const Recording& recording) {
  struct Fastest {
    double excess = 0, speed = 0, time = 0, vehicle = 0;
    int part = -1;
    bool touched = false;
    double own = 0;  // [m/s] before the first touch of a vehicle
  };
  std::vector<Fastest> found(model.persons.size());
  double vehicle = 0;  // [m/s] the fastest so far
  for (const Snapshot& s : recording.snapshots) {
    for (const Vehicle& v : model.vehicles)
      if (model.bodies[static_cast<std::size_t>(v.body)].person < 0 || &s == &recording.snapshots.front())  // mounts are flung too
        vehicle = std::max(vehicle, s.bodies[static_cast<std::size_t>(v.body)].V_WB.v.norm());
    for (const ContactRecord& c : s.contacts)
      if (const int p = model.bodies[static_cast<std::size_t>(c.body_a)].person; c.shapes.on_vehicle() && p >= 0)
        found[static_cast<std::size_t>(p)].touched = true;
    for (std::size_t p = 0; p < found.size(); ++p)
      for (const int b : model.persons[p].bodies) {
        Fastest& f = found[p];
        const double speed = s.bodies[static_cast<std::size_t>(b)].V_WB.v.norm();
        if (!f.touched) f.own = std::max(f.own, speed);
        if (const double excess = speed - kTimes * vehicle - f.own - kBeside; f.touched && excess > f.excess)
          f.excess = excess, f.speed = speed, f.time = s.time, f.vehicle = vehicle, f.part = b;
      }
  }
  std::vector<std::string> out;
  for (const Fastest& f : found)
    if (f.part >= 0)
      out.push_back(model.bodies[static_cast<std::size_t>(f.part)].name + " had " + with_one_digit(f.speed) + " m/s at " +
                    std::to_string(std::lround(1e3 * f.time)) + " ms, where no vehicle was faster than " +
                    with_one_digit(f.vehicle) +
                    " m/s: it was pinched, do not rely on its motion; see what a smaller step and the other contact_law say");
  return out;
}

}  // namespace engine
