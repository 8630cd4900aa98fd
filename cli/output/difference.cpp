#include "cli/output/difference.h"

#include <fmt/format.h>

#include "cli/exit.h"
#include "cli/output/json.h"
#include "scenes/loader/value.h"

namespace cli {

Json difference_json(const render::Difference& found) {
  Json out = Json::object();
  for (const render::Measure& measure : render::measures()) out[measure.name] = number_json(found.*measure.value);
  return out;
}

Json limits_json(const render::Limits& limits) {
  Json out = Json::object();
  for (const render::Measure& measure : render::measures())
    if (measure.limit) out[measure.name] = limits.*measure.limit;
  return out;
}

std::string difference_text(const render::Difference& d, const render::Limits& limits) {
  return fmt::format(
      "{:.0f} pixels differ, {:.4f} % by more than 2 (limit {} %), {:.0f} by more than 32 (limit {}), largest {:.0f}, rms {:.4f} "
      "(limit {}), PSNR {:.1f} dB (limit {}), SSIM {:.5f} (limit {}), seen by an eye {:.4f} (limit {}), at worst {:.3f} (limit {})",
      d.differing, 100 * d.share_above_2, 100 * limits.share_above_2, d.above_32, limits.above_32, d.largest, d.rms, limits.rms,
      d.psnr_dB, limits.psnr_dB, d.ssim, limits.ssim, d.perceptual_mean, limits.perceptual_mean, d.perceptual_worst,
      limits.perceptual_worst);
}

void set_limit(render::Limits& limits, const std::string& name, double value) {
  std::vector<std::string> names;
  for (const render::Measure& measure : render::measures()) {
    if (measure.limit == nullptr) continue;
    names.emplace_back(measure.name);
    if (name != measure.name) continue;
    limits.*measure.limit = value;
    return;
  }
  const std::string near = scenes::nearest(name, names);
  throw UsageError(
      fmt::format("--limit: there is no limit \"{}\"; {}", name,
                  near.empty() ? fmt::format("take one of {}", fmt::join(names, ", ")) : fmt::format("did you mean {}?", near)));
}

}  // namespace cli
