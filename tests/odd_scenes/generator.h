// Valid but odd scenes: a base scene with a few of its values, or of those it leaves out, changed to anything their line of the
// table of keys allows, and beyond what anybody would write. New keys are found by themselves. What the loader refuses is taken
// back, so that an odd scene is a command line: crashreel simulate BASE --set ... --set ...
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "scenes/loader/table.h"
#include "scenes/loader/value.h"
#include "scenes/scene.h"

namespace odd {

struct OddScene {
  std::filesystem::path base;
  std::vector<std::string> overrides;
  scenes::Scene scene;
};

class Generator {
 public:
  /// Base scenes with their weights: how often each is taken.
  struct Base {
    std::filesystem::path file;
    double weight = 1;
  };
  explicit Generator(const std::vector<Base>&);

  /// The scene of this seed: always the same. `duration` [s] is what it is made to last.
  OddScene make(std::uint64_t seed, double duration) const;

 private:
  /// A value of a base scene that can be changed.
  struct Place {
    std::string path;  // "body.0.mass"
    const scenes::Key* key;
    double present = 0;  // [SI] what stands there, 0 if nothing
  };
  struct Loaded {
    std::filesystem::path file;
    std::vector<Place> places;
  };
  void collect(const scenes::Section&, const scenes::Value&, const std::string& path, std::vector<Place>&) const;

  std::vector<Loaded> bases_;
  std::shared_ptr<scenes::MeshShelf> meshes_ = std::make_shared<scenes::MeshShelf>();
  std::vector<double> weights_;
};

}  // namespace odd
