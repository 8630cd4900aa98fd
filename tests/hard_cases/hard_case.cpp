#include "tests/hard_cases/hard_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numbers>

#include "scenes/scene.h"

namespace hard_cases {
namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool all_finite(const engine::Recording& recording) {
  for (const engine::Snapshot& s : recording.snapshots) {
    if (!std::isfinite(energy(s))) return false;
    for (const auto& [X, V] : s.bodies)
      if (!X.p.allFinite() || !X.q.coeffs().allFinite() || !V.v.allFinite() || !V.w.allFinite()) return false;
    for (const engine::ContactRecord& c : s.contacts)
      if (!c.force.allFinite() || !c.impulse.allFinite() || !c.point.allFinite()) return false;
  }
  return true;
}

void print_row(const char* name, const std::string& setting, const std::string& wall, const char* figures, va_list arguments) {
  std::printf("%-26s %-24s %9s  ", name, setting.c_str(), wall.c_str());
  std::vprintf(figures, arguments);
  std::printf("\n");
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Setting& setting) {
  return out << setting.step << ' ' << setting.scheme;
}

engine::Model model_of(const std::string& scene, std::vector<std::string> overrides) {
  const std::string root = CRASHREEL_SOURCE_DIR "/";
  const bool elsewhere = scene.find('/') != std::string::npos;
  return scenes::load(root + (elsewhere ? scene : "tests/hard_cases/" + scene) + ".toml", overrides).model;
}

Outcome run(engine::Model model, const std::string& setting) {
  Outcome out{std::move(model), {}, 0, setting};
  const double start = seconds();
  out.recording = engine::simulate(out.model);
  out.wall_s = seconds() - start;
  EXPECT_FALSE(out.recording.failure) << out.recording.failure->message << " at " << out.recording.failure->time << " s";
  EXPECT_TRUE(all_finite(out.recording));
  EXPECT_EQ(engine::hash(engine::simulate(out.model)), engine::hash(out.recording)) << "a second run differs";
  return out;
}

Outcome run(const std::string& scene, const Setting& setting, std::vector<std::string> overrides,
            const std::function<void(engine::Model&)>& change) {
  overrides.push_back(std::string("simulation.step=") + setting.step);
  overrides.push_back(std::string("simulation.scheme=") + setting.scheme);
  engine::Model model = model_of(scene, std::move(overrides));
  if (change) change(model);
  return run(std::move(model), std::string(setting.step) + " " + setting.scheme);
}

void row(const char* name, const Outcome& it, const char* figures, ...) {
  char wall[32];
  std::snprintf(wall, sizeof wall, "%.2f s", it.wall_s);
  va_list arguments;
  va_start(arguments, figures);
  print_row(name, it.setting, wall, figures, arguments);
  va_end(arguments);
}

void row(const char* name, const std::string& setting, const char* figures, ...) {
  va_list arguments;
  va_start(arguments, figures);
  print_row(name, setting, "", figures, arguments);
  va_end(arguments);
}

double energy(const engine::Snapshot& s) {
  return s.energies.kinetic + s.energies.potential;
}

Rises rises(const engine::Recording& recording) {
  Rises out;
  for (std::size_t i = 1; i < recording.snapshots.size(); ++i) {
    const double rise = energy(recording.snapshots[i]) - energy(recording.snapshots[i - 1]);
    out.largest = std::max(out.largest, rise);
    out.sum += std::max(0.0, rise);
  }
  return out;
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

}  // namespace hard_cases
