// Scenes whose answers are known in closed form, with random values: what a study is held against.
#pragma once

#include <map>
#include <random>
#include <span>
#include <string>

namespace closed_forms {

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  int whole(int low, int high) { return std::uniform_int_distribution<>(low, high)(engine_); }

 private:
  std::mt19937_64 engine_;
};

/// A scene file and what comes out of it, by quantity, in the unit of its key.
struct Known {
  std::string scene;
  std::map<std::string, double> answers;
};

struct Family {
  const char* name;
  Known (*make)(Chance&);
};

std::span<const Family> families();

}  // namespace closed_forms
