#include "cli/apart.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "cli/exit.h"

namespace cli {
namespace {

constexpr char kFailed = 'E', kWorked = 'W';  // heads a message; what follows are texts, each ended by a zero byte

void send(int to, const std::string& message) {
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t n = write(to, message.data() + sent, message.size() - sent);
    if (n < 0 && errno != EINTR) _exit(1);
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
}

[[noreturn]] void child(int to, const std::function<std::vector<std::string>()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::string message(1, kWorked);
  try {
    for (const std::string& text : work()) message += text + '\0';
  } catch (const std::bad_alloc&) {
    _exit(1);
  } catch (const std::exception& error) {
    message = kFailed + std::string(error.what()) + '\0';
  }
  send(to, message);
  _exit(0);
}

std::string received(int from) {
  std::string out;
  char piece[4096];
  for (;;) {
    const ssize_t n = read(from, piece, sizeof piece);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return out;
    out.append(piece, static_cast<std::size_t>(n));
  }
}

}  // namespace

std::vector<std::string> apart(const std::string& what, const std::function<std::vector<std::string>()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw MachineError(fmt::format("drawing {}: {}", what, std::strerror(errno)));
  const pid_t worker = fork();
  if (worker == 0) child(ends[1], work);
  const int failed = errno;
  close(ends[1]);
  const std::string message = worker < 0 ? "" : received(ends[0]);
  close(ends[0]);
  if (worker < 0) throw MachineError(fmt::format("drawing {}: {}", what, std::strerror(failed)));
  int status = 0;
  while (waitpid(worker, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || message.empty())
    throw MachineError(fmt::format("drawing {}: its process was ended, most likely for want of memory", what));
  std::vector<std::string> out;
  for (std::size_t at = 1; at < message.size(); at += out.back().size() + 1) out.emplace_back(message.c_str() + at);
  if (message[0] == kFailed) throw MachineError(out.front());
  return out;
}

}  // namespace cli
