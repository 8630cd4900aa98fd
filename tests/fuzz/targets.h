// What reads text and bytes from strangers, or draws whatever numbers come, each as one function over any bytes. The tests replay
// the corpus; with CRASHREEL_FUZZ defined targets.cpp makes a libFuzzer program of all of them. A new one is a function and a line
// here and a line in the table of targets.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fuzz {

/// Each ends the process when a promise is broken: a number that is not finite gets through, an exception of a foreign kind.
void scene(std::string_view);
void quantity(std::string_view);
void frames(std::string_view);
void png(std::string_view);
void mesh(std::string_view);
void cage(std::string_view);
void arguments(std::string_view);
void request(std::string_view);
void journal(std::string_view);
void state(std::string_view);
void recording(std::string_view);
void chart(std::string_view);

/// What the program itself writes for some of them, sound to the last byte whatever the formats are today. Ends the process when it
/// is not read again.
std::vector<std::string> written_journal();
std::vector<std::string> written_state();
std::vector<std::string> written_recording();

struct Target {
  const char* name;
  void (*run)(std::string_view);
  std::vector<std::string> (*written)() = nullptr;
  int mutants = 3000;  // of each input, in the tests; fewer where one takes longer than a tenth of a millisecond
};
std::span<const Target> targets();

/// Ends the process with the promise's words unless it holds.
void demand(bool holds, const char* promise);

/// The bytes as a file, where a reader takes files only; its name.
const std::string& file_of(std::string_view bytes);

}  // namespace fuzz
