#include "cli/build_id.h"

#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <cstring>
#include <stdexcept>

namespace cli {
namespace {

/// The build ID among the notes of a segment; empty if it is not there. Names and values fill whole words (elf(5)).
std::string id_among(const char* notes, std::size_t size) {
  constexpr auto whole = [](std::size_t bytes) { return (bytes + 3) & ~std::size_t{3}; };
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes + at, sizeof note);
    const char* name = notes + at + sizeof note;
    const char* value = name + whole(note.n_namesz);
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0) {
      std::string id;
      for (std::size_t i = 0; i < note.n_descsz; ++i) id += fmt::format("{:02x}", static_cast<unsigned char>(value[i]));
      return id;
    }
    at = static_cast<std::size_t>(value - notes) + whole(note.n_descsz);
  }
  return "";
}

/// Of dl_iterate_phdr(3), which names the program first.
int take_id(dl_phdr_info* program, std::size_t, void* id) {
  for (int i = 0; i < program->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = program->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE || !static_cast<std::string*>(id)->empty()) continue;
    *static_cast<std::string*>(id) = id_among(reinterpret_cast<const char*>(program->dlpi_addr + segment.p_vaddr), segment.p_memsz);
  }
  return 1;
}

}  // namespace

std::string build_id() {
  std::string id;
  dl_iterate_phdr(take_id, &id);
  if (id.empty()) throw std::logic_error("this program was linked without a build ID");
  return id;
}

}  // namespace cli
