// The step loop allocates nothing once it has begun: every buffer has its size from the start. malloc itself is counted, from which
// operator new and Eigen take theirs.
#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/record/recorder.h"
#include "engine/start.h"
#include "engine/step/step.h"
#include "scenes/scene.h"
#include "tests/effects/scenes.h"

#ifndef __SANITIZE_ADDRESS__  // which has a malloc of its own

namespace {

thread_local bool counting = false;
thread_local long allocations = 0;

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  allocations += counting;
  return __libc_malloc(size);
}
void* realloc(void* memory, std::size_t size) {
  allocations += counting;
  return __libc_realloc(memory, size);
}
void* calloc(std::size_t number, std::size_t size) {
  allocations += counting;
  return __libc_calloc(number, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  allocations += counting;
  return __libc_memalign(alignment, size);
}
}

namespace effects_tests {

using namespace engine;

TEST(AllocationCounter, SeesAVectorGrowAndEigenToo) {
  counting = true;
  allocations = 0;
  std::vector<double> grown(100);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(40, 40);
  counting = false;
  EXPECT_EQ(allocations, 2) << grown.size() << matrix.rows();
}

class StepLoop : public testing::TestWithParam<std::string> {};

TEST_P(StepLoop, AllocatesNothingAfterWarmUp) {
  constexpr int kWarmUp = 20;  // steps; nothing has touched by then that does not lie there from the start
  constexpr int kSteps = 1200;
  const scenes::Scene scene = scenes::load(std::filesystem::path(CRASHREEL_SOURCE_DIR) / GetParam());
  const Plan plan = compile(scene.model);
  const RunOptions options;
  World world(scene.model, plan, options);
  State state = start(world);
  Recording recording;
  Recorder recorder(world, state);
  Stepper stepper(world, [&](const std::vector<Constraint>& conditions, double time, double duration) {
    recorder.tally(world, conditions, time, duration);
  });
  const double h = scene.model.settings.step;
  std::string where;
  allocations = 0;
  for (int k = 0; k < kSteps && !world.log.failure; ++k) {
    const long before = allocations;
    counting = k >= kWarmUp;
    for (double left = h; left > 1e-9 * h && !world.log.failure;) left -= stepper.advance(state, left);
    recorder.sample(world, state, recording);
    counting = false;
    state.time = (k + 1) * h;
    if (allocations > before && where.size() < 200) where += " " + std::to_string(k);
  }
  EXPECT_EQ(allocations, 0) << "in steps" << where;
}

INSTANTIATE_TEST_SUITE_P(Scenes, StepLoop, testing::ValuesIn(moving_scenes()),
                         [](const auto& scene) { return test_name(scene.param); });

}  // namespace effects_tests

#endif
