// Runs the program as a user's script does: a child process, its exit code, what it printed where.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace cli_tests {

/// The program built beside these tests, or one built with sanitizers: ./tests/run --sanitize names it.
inline const char* sanitized_program() {
  return std::getenv("CRASHREEL_SANITIZED_PROGRAM");
}
inline const char* program() {
  const char* other = sanitized_program();
  return other ? other : CRASHREEL_PROGRAM;
}

inline std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// A folder of its own for one test, gone afterwards.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "crashreel_test_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name, std::ios::binary) << text; }

 private:
  std::filesystem::path path_;
};

struct Result {
  int code = -1;
  std::string out;
  std::string err;
};

/// Runs the program inside `folder`, with NAME=value pairs added to the environment.
inline Result run(const Folder& folder, const std::vector<std::string>& arguments,
                  const std::vector<std::string>& environment = {}) {
  const auto quoted = [](const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
  };
  std::string command = "cd " + quoted(folder.path().string()) + " && env";
  for (const std::string& pair : environment) command += " " + quoted(pair);
  command += " " + quoted(program());
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " >.stdout 2>.stderr </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder / ".stdout"), contents(folder / ".stderr")};
}

/// Runs a line of a shell inside `folder`, the program as $P: "ulimit -n 4; $P render ...".
inline Result under_shell(const Folder& folder, const std::string& line) {
  const std::string said = folder.path().string() + ".said";
  const std::string command =
      "cd '" + folder.path().string() + "' && P='" + program() + "' && ( " + line + " ) >'" + said + "' 2>'" + said + ".too'";
  const int status = std::system(command.c_str());
  Result out{WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(said), contents(said + ".too")};
  for (const std::string& file : {said, said + ".too"}) std::filesystem::remove(file);
  return out;
}

/// What lies in a folder, by name.
inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

/// A ball dropped from 20 cm: the smallest scene in which something happens.
inline const std::string kBall = R"(title = "Ball"

[simulation]
duration = "0.4 s"
stop_at_rest = false

[[body]]
name = "ball"
mass = "2 kg"
axes = "0.1 0.1 0.1 m"
position = "0 0 0.3 m"
velocity = "1 0 0 m/s"
friction = 0.5

[[camera]]
name = "side"
position = "0 -3 1 m"
target = "0 0 0.2 m"

[[camera]]
name = "above"
kind = "top"
)";

/// The ball's scene with one line replaced.
inline std::string ball_with(const std::string& line, const std::string& replacement) {
  std::string text = kBall;
  const std::size_t at = text.find(line);
  return text.replace(at, line.size(), replacement);
}

}  // namespace cli_tests
