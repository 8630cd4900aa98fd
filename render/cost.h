// What a frame costs, pass by pass, in processor time: that does not grow when the machine is busy with other work.
#pragma once

#include <array>
#include <cstddef>

namespace render {

enum class Pass { arrange, set_up, shadow, background, objects, light, lines, read_back, labels, convert };
constexpr std::array kPassNames{"arrange", "set-up", "shadows", "background", "objects",
                                "light",   "lines",  "read",    "labels",     "convert"};
constexpr std::size_t kPasses = kPassNames.size();

/// [ms] of processor time by pass.
using FrameCost = std::array<double, kPasses>;

void add(const FrameCost&, FrameCost& sum);
double together(const FrameCost&);

// arrange: positions and overlays of the moment; set-up: levels of detail, upload; objects: what each sample sees; light: shading
// of what is seen; convert: to the encoder's colours, or to a PNG file

/// Of this process with all its threads [ms].
double processor_ms();

class Stopwatch {
 public:
  explicit Stopwatch(FrameCost& cost) : cost_(&cost), since_(processor_ms()) {}
  /// What passed since the last lap went into this pass.
  void lap(Pass);

 private:
  FrameCost* cost_;
  double since_;
};

/// What a film cost. The first frame of a worker compiles its shaders; it counts apart.
struct FilmCost {
  int workers = 0;
  int first_frames = 0, later_frames = 0;
  FrameCost first{}, later{};  // [ms] summed
  double encode_ms = 0;        // of the process that hands out the frames and encodes them
  double wall_s = 0;
};

}  // namespace render
