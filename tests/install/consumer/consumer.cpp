// Ten lines of somebody else's program: runs a scene and prints how far the first vehicle went.
#include <cstdio>

#include "engine/simulate.h"
#include "scenes/scene.h"

int main(int, char** arguments) {
  const scenes::Scene scene = scenes::load(arguments[1]);
  const engine::Recording run = engine::simulate(scene.model);
  std::printf("%.3f\n", run.snapshots.back().bodies[0].X_WB.p.x() - run.snapshots.front().bodies[0].X_WB.p.x());
}
