// import_assets MESHES OUT: has every mesh of a folder read as the program would, and writes what came out of it to OUT.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "scenes/loader/mesh.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
      if (entry.path().extension() != ".obj") continue;
      const std::string kept = scenes::kept_import(entry.path());
      std::ofstream file(std::filesystem::path(argv[2]) / (entry.path().filename().string() + ".imported"), std::ios::binary);
      if (!(file << kept).flush()) throw std::runtime_error("cannot write to " + std::string(argv[2]));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "import_assets: %s\n", error.what());
    return 1;
  }
  return 0;
}
