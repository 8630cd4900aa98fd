// Compilers evaluate the arguments of a call in whatever order they like: each throw of the dice has a statement of its own.
#include "tests/hard_cases/accident.h"

#include <fmt/core.h>
#include <random>

namespace hard_cases {
namespace {

struct VehicleKind {
  const char* model;
  double half_length;  // [m] to its farthest corner, rounded up
};
constexpr VehicleKind kVehicles[] = {{"sedan", 2.7}, {"small_car", 2.3}, {"suv", 2.6}, {"van", 3.1}, {"bus", 6.4}, {"truck", 5.2}};
constexpr const char* kFigures[] = {"person-14", "person-16", "child-3", "child-6", "child-10"};
constexpr const char* kUpright[] = {"standing", "walking_left", "walking_right", "leaning", "prayer", "cat", "sitting"};
constexpr const char* kLow[] = {"lying_prone", "lying_supine", "sitting_upright", "cat"};
constexpr const char* kSteps[] = {"2 ms", "1 ms", "0.5 ms"};

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  template <class T, std::size_t n>
  const T& one_of(const T (&all)[n]) {
    return all[static_cast<std::size_t>(between(0, static_cast<double>(n)))];
  }
  bool chance(double p) { return between(0, 1) < p; }

 private:
  std::mt19937_64 random_;
};

std::string vehicle(Dice& dice, const std::string& name, const char* model, const std::string& place, double least, double most) {
  std::string text = fmt::format("[[vehicle]]\nname = \"{}\"\nmodel = \"{}\"\n{}speed = \"{:.1f} km/h\"\n", name, model, place,
                                 dice.between(least, most));
  if (dice.chance(0.7)) text += "[vehicle.brake]\nfrom = \"0 s\"\nbuild_up = \"0.2 s\"\ndeceleration = \"0.7 g\"\n";
  return text;
}

std::string person(Dice& dice, const std::string& name, const char* pose, double x) {
  const double heading = dice.between(0, 360);
  const double y = dice.between(-0.4, 0.4);
  const char* figure = dice.one_of(kFigures);
  return fmt::format(
      "[[person]]\nname = \"{}\"\nfigure = \"{}\"\npose = \"{}\"\nposition = \"{} {:.3f} m\"\nheading = \"{:.0f} deg\"\n", name,
      figure, pose, x, y, heading);
}

std::string cyclist(Dice& dice) {
  const double speed = dice.between(0, 25);
  const double heading = dice.between(0, 360);
  const double y = dice.between(-0.5, 0.5);
  return fmt::format(
      "[[vehicle]]\nname = \"bicycle\"\nmodel = \"bicycle\"\nposition = \"0.6 {:.3f} m\"\nheading = \"{:.0f} deg\"\nspeed = "
      "\"{:.1f} km/h\"\n"
      "[[person]]\nname = \"rider\"\nfigure = \"person-14\"\npose = \"cyclist\"\nrides = \"bicycle\"\n",
      y, heading, speed);
}

std::string second_vehicle(Dice& dice) {
  const VehicleKind& kind = dice.one_of(kVehicles);
  const double heading = dice.between(0, 360);
  const double y = dice.between(-1, 1);
  const double x = 1.2 + kind.half_length + dice.between(0, 2);
  const double most = dice.chance(0.5) ? 0 : 60;
  return vehicle(dice, "other", kind.model,
                 fmt::format("position = \"{:.3f} {:.3f} m\"\nheading = \"{:.0f} deg\"\n", x, y, heading), 0, most);
}

}  // namespace

std::string accident(unsigned number, const char* law) {
  Dice dice(number);
  std::string text =
      fmt::format("[simulation]\nduration = \"1.5 s\"\ncontact_law = \"{}\"\nstep = \"{}\"\n", law, dice.one_of(kSteps));
  const double front = dice.between(-0.9, 0.9);
  const char* first = dice.one_of(kVehicles).model;
  text += vehicle(dice, "car", first, fmt::format("front = \"-1.3 {:.3f} m\"\n", front), 5, 100);
  const double kind = dice.between(0, 1);
  if (kind < 0.2) return text + cyclist(dice);
  if (kind < 0.55) text += second_vehicle(dice);
  const bool low = dice.chance(0.25);
  const char* pose = low ? dice.one_of(kLow) : dice.one_of(kUpright);
  text += person(dice, "one", pose, 0);
  if (kind > 0.8) {
    const char* other = dice.one_of(kUpright);
    text += person(dice, "two", other, 2.3);
  }
  return text;
}

}  // namespace hard_cases
