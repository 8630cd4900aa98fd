#include "cli/disk_room.h"

#include <fmt/format.h>

#include <filesystem>

#include "cli/estimate.h"

namespace cli {
namespace {

namespace fs = std::filesystem;

/// [byte] of a pixel in a film, at least twice what the flagship takes at 640x360 (0.006, 0.24 and 0.53).
double bytes_per_pixel(render::Container container) {
  if (container == render::Container::mp4) return 0.02;
  return container == render::Container::mkv ? 0.5 : 1.1;
}

/// The folder the output goes into, or the nearest one above it that is there.
fs::path existing_folder(const fs::path& output) {
  fs::path folder = output.parent_path();
  std::error_code unknown;
  while (!folder.empty() && folder.has_relative_path() && !fs::is_directory(folder, unknown)) folder = folder.parent_path();
  return folder.empty() ? "." : folder;
}

}  // namespace

std::optional<std::string> short_of_room(const render::FilmJob& job, int frames) {
  const fs::path folder = existing_folder(job.output);
  std::error_code unknown;
  const fs::space_info space = fs::space(folder, unknown);
  if (unknown) return std::nullopt;
  const double bytes = bytes_per_pixel(job.container) * frames * job.width * job.height;
  const auto room = static_cast<double>(space.available);
  if (room >= bytes) return std::nullopt;
  return fmt::format("the disk of {} has {} left; {} may take {}", folder == "." ? "this folder" : folder.string(),
                     bytes_text(room), job.output.string(), bytes_text(bytes));
}

}  // namespace cli
