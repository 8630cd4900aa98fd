#include "tests/fuzz/targets.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/parse.h"
#include "engine/geometry/triangle_mesh.h"
#include "render/error.h"
#include "render/image/png.h"
#include "render/surface/skin.h"
#include "scenes/loader/mesh.h"
#include "scenes/loader/quantity.h"
#include "scenes/scene.h"

namespace fuzz {
namespace {

/// The same PNG with checksums that fit: chance does not hit a CRC, and what lies behind it would never be read.
std::string with_checksums(std::string_view bytes) {
  std::string out(bytes);
  const auto number = [&out](std::size_t at) {
    std::uint32_t n = 0;
    for (std::size_t k = 0; k < 4; ++k) n = n << 8 | static_cast<unsigned char>(out[at + k]);
    return n;
  };
  for (std::size_t at = 8; at + 12 <= out.size();) {
    const std::size_t length = std::min<std::size_t>(number(at), out.size() - at - 12);
    const auto sum =
        static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(out.data() + at + 4), static_cast<uInt>(length + 4)));
    for (std::size_t k = 0; k < 4; ++k) out[at + 8 + length + k] = static_cast<char>(sum >> (24 - 8 * k));
    at += 12 + length;
  }
  return out;
}

constexpr Target kTargets[] = {{"scene", scene},
                               {"quantity", quantity},
                               {"frames", frames},
                               {"png", png},
                               {"mesh", mesh},
                               {"cage", cage},
                               {"arguments", arguments, nullptr, 500},
                               {"request", request},
                               {"journal", journal, written_journal},
                               {"state", state, written_state},
                               {"recording", recording, written_recording},
                               {"chart", chart, nullptr, 1000}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

void demand(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

const std::string& file_of(std::string_view bytes) {
  // the same file in memory again and again: a new one each time would cost more than reading it
  static std::string name;
  static int file = -1;
  if (file < 0) {
    const char* folder = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
    name = std::string(folder) + "/crashreel_fuzz_" + std::to_string(getpid());
    file = open(name.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    demand(file >= 0, "a temporary file can be made");
    std::atexit([] { unlink(name.c_str()); });
  }
  demand(ftruncate(file, 0) == 0 && pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
         "a temporary file can be written");
  return name;
}

void scene(std::string_view bytes) {
  const std::string& file = file_of(bytes);
  try {
    const scenes::Scene found = scenes::load(file);
    demand(std::isfinite(found.model.settings.step) && found.model.settings.step > 0, "a loaded scene has a step");
    for (const engine::Body& body : found.model.bodies) {
      demand(body.mass > 0 && std::isfinite(body.mass), "a loaded body has a mass");
      demand(body.X_WB.p.allFinite() && body.X_WB.q.coeffs().allFinite() && body.V_WB.v.allFinite() && body.V_WB.w.allFinite(),
             "a loaded body is somewhere");
    }
  } catch (const scenes::SceneErrors& errors) {
    demand(!errors.lines.empty(), "a refused scene says why");
  }
}

void quantity(std::string_view bytes) {
  if (bytes.empty()) return;
  constexpr int kDimensions = static_cast<int>(scenes::Dimension::inertia) + 1;
  const auto dimension = static_cast<scenes::Dimension>(static_cast<unsigned char>(bytes[0]) % kDimensions);
  const scenes::Quantity found = scenes::parse_quantity(std::string(bytes.substr(1)), dimension);
  demand(!found.problem.empty() || std::isfinite(found.value), "a quantity without a problem is a finite number");
}

void frames(std::string_view bytes) {
  const std::string text(bytes);
  try {
    for (const auto& [first, last, step] : cli::parse_frames("--frames", text)) {
      demand(first >= 0 && (last < 0 || first <= last), "frames are counted from 0, first to last");
      demand(step >= 1, "frames go forward");
    }
  } catch (const cli::UsageError&) {
  }
  try {
    demand(cli::parse_time("--at", text) >= 0, "a time is not negative");
  } catch (const cli::UsageError&) {
  }
  try {
    const auto [width, height] = cli::parse_size("--size", text);
    demand(width >= 16 && height >= 16, "a size is a size");
  } catch (const cli::UsageError&) {
  }
}

void png(std::string_view bytes) {
  const std::string& file = file_of(with_checksums(bytes));
  try {
    render::TextChunks text;
    const render::Image image = render::read_png(file, &text);
    demand(image.rgba.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4,
           "a picture has four bytes a pixel");
  } catch (const render::RenderError&) {
  }
}

void cage(std::string_view bytes) {
  // what a worker says that somebody has taken over
  const scenes::CageResult found = scenes::unpacked(std::string(bytes));
  demand(found.problem.empty() || found.parts.empty(), "a message that is refused brings nothing");
  for (const scenes::RawPart& part : found.parts) {
    demand(part.normals.empty() || part.normals.size() == part.positions.size(), "a normal for each corner, or none");
    for (const std::uint32_t i : part.indices) demand(3 * std::size_t{i} + 2 < part.positions.size(), "corners that are there");
    for (const float value : {part.colour[0], part.colour[1], part.colour[2], part.opacity})
      demand(value >= 0 && value <= 1, "colours between black and white");
  }
  scenes::audit(found.parts, "m");
}

void mesh(std::string_view bytes) {
  // coordinates as the bytes have them, NaN and all; then corners among them
  scenes::RawPart part;
  const std::size_t vertices = std::min<std::size_t>(bytes.size() / 16, 64);
  if (vertices < 3) return;
  part.positions.resize(3 * vertices);
  std::memcpy(part.positions.data(), bytes.data(), part.positions.size() * sizeof(float));
  part.normals.resize(part.positions.size());
  for (std::size_t i = 3 * vertices * sizeof(float); i < bytes.size(); ++i)
    part.indices.push_back(static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i]) % vertices));
  part.indices.resize(part.indices.size() / 3 * 3);
  std::vector<scenes::RawPart> parts{part};
  scenes::audit(parts, "m");
  std::vector<engine::Vec3> corners;
  std::vector<engine::Triangle> triangles;
  for (std::size_t i = 0; i + 2 < part.positions.size(); i += 3) {
    const auto sound = [&](std::size_t k) {
      return std::abs(part.positions[i + k]) <= 1e6f ? static_cast<double>(part.positions[i + k]) : 0.0;
    };
    corners.emplace_back(sound(0), sound(1), sound(2));
  }
  const auto corner = [&](std::size_t i) { return static_cast<std::int32_t>(part.indices[i]); };
  for (std::size_t i = 0; i < part.indices.size(); i += 3) triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
  const engine::TriangleMesh solid(std::move(corners), std::move(triangles));
  demand(solid.triangles().empty() || (solid.bounds().lower.allFinite() && solid.bounds().upper.allFinite()), "a mesh has bounds");
}

void arguments(std::string_view bytes) {
  // words as a shell hands them over, parted by line feeds; a word ends at its first zero
  std::vector<std::string> words{"crashreel"};
  for (std::size_t at = 0; at <= bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    words.emplace_back(bytes.substr(at, end - at));
    at = end + 1;
  }
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  try {
    demand(static_cast<bool>(cli::read_command_line(static_cast<int>(argv.size()), argv.data())), "a command line asks for a job");
  } catch (const cli::UsageError& error) {
    demand(error.what()[0] != '\0', "a refused command line says why");
  }
}

}  // namespace fuzz

#ifdef CRASHREEL_FUZZ
namespace {

const fuzz::Target* chosen = nullptr;

/// What the program itself writes, as files in FOLDER/<target>.
void write_inputs(const std::filesystem::path& folder) {
  for (const fuzz::Target& target : fuzz::targets()) {
    int number = 0;
    std::filesystem::create_directories(folder / target.name);
    for (const std::string& input : target.written ? target.written() : std::vector<std::string>())
      std::ofstream(folder / target.name / ("written_" + std::to_string(number++)), std::ios::binary) << input;
  }
}

}  // namespace

// The target is the one that CRASHREEL_FUZZ_TARGET names, as in all processes that libFuzzer starts. Without it: names of all, and
// into the folder that is named what the program writes for them.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const char* name = std::getenv("CRASHREEL_FUZZ_TARGET");
  for (const fuzz::Target& target : fuzz::targets()) {
    if (!name) std::puts(target.name);
    if (name && std::string_view(name) == target.name) chosen = &target;
  }
  if (!name && *argc > 1) write_inputs((*argv)[1]);
  if (!name) std::exit(0);
  fuzz::demand(chosen != nullptr, "CRASHREEL_FUZZ_TARGET names a target");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
#endif
