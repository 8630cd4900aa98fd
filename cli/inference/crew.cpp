#include "cli/inference/crew.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "cli/exit.h"
#include "cli/process.h"
#include "render/workers.h"

namespace cli::inference {
namespace {

using Work = std::function<std::string(std::size_t)>;

constexpr int kLookEvery = 200;  // [ms] at a signal that asks to stop

/// One process: it reads a number, works, answers, and ends when there is nothing more to read.
struct Member {
  std::optional<render::Worker> process;
  int to = -1, from = -1;
  bool busy = false;
  std::size_t piece = 0;
  std::string text;  // of its answer, so far
};

bool write_all(int file, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = write(file, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// The life of a member; its exit code.
int serve(int in, int out, const Work& work) {
  // the terminal's Ctrl-C goes to all; the parent decides, and what runs is stopped by it
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  std::uint64_t piece = 0;
  for (;;) {
    const ssize_t n = read(in, &piece, sizeof piece);
    if (n < 0 && errno == EINTR) continue;
    if (n != sizeof piece) return 0;
    std::string line;
    try {
      line = work(static_cast<std::size_t>(piece));
    } catch (const std::exception& error) {
      fmt::print(stderr, "crashreel: {}\n", error.what());
      std::fflush(stderr);
      return 1;
    }
    if (!write_all(out, line.data(), line.size())) return 1;
  }
}

class Crew {
 public:
  Crew(int jobs, const Work& work) : members_(static_cast<std::size_t>(jobs)), work_(work) {
    for (Member& m : members_) start(m);
  }
  ~Crew() {
    for (Member& m : members_) close_pipes(m);
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  void start(Member& m) {
    int down[2], up[2];
    if (pipe(down) != 0 || pipe(up) != 0) throw MachineError(fmt::format("starting a run: {}", std::strerror(errno)));
    m.process.emplace([&] {
      for (Member& other : members_) close_pipes(other);
      close(down[1]);
      close(up[0]);
      return serve(down[0], up[1], work_);
    });
    close(down[0]);
    close(up[1]);
    m.to = down[1];
    m.from = up[0];
    m.busy = false;
    m.text.clear();
  }

  /// How it ended, in words.
  static std::string end(Member& m) {
    close_pipes(m);
    const int status = m.process->wait();
    m = Member{};
    if (WIFSIGNALED(status)) return fmt::format("signal {} ({})", WTERMSIG(status), render::ending(status));
    return render::ending(status);
  }

  void give(Member& m, std::size_t piece) {
    const std::uint64_t number = piece;
    m.busy = true;
    m.piece = piece;
    write_all(m.to, reinterpret_cast<const char*>(&number), sizeof number);  // a dead one shows when it is read from
  }

  std::vector<Member>& members() { return members_; }

 private:
  static void close_pipes(Member& m) {
    for (int* end : {&m.to, &m.from})
      if (*end >= 0) close(std::exchange(*end, -1));
  }

  std::vector<Member> members_;
  const Work& work_;
};

}  // namespace

void run_crew(std::size_t count, int jobs, const Work& work,
              const std::function<void(std::size_t, const std::string&, const std::string&)>& take) {
  if (count == 0) return;
  Crew crew(static_cast<int>(std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, jobs)))), work);
  std::size_t next = 0, done = 0;
  while (done < count) {
    std::vector<pollfd> watched;
    std::vector<Member*> whose;
    for (Member& m : crew.members()) {
      if (!m.busy && next < count) crew.give(m, next++);
      if (!m.busy) continue;
      watched.push_back({m.from, POLLIN, 0});
      whose.push_back(&m);
    }
    if (poll(watched.data(), watched.size(), kLookEvery) < 0 && errno != EINTR)
      throw MachineError(fmt::format("waiting for a run: {}", std::strerror(errno)));
    check_interrupted();
    for (std::size_t i = 0; i < watched.size(); ++i) {
      if (watched[i].revents == 0) continue;
      Member& m = *whose[i];
      char piece[1 << 14];
      const ssize_t n = read(m.from, piece, sizeof piece);
      if (n < 0 && errno == EINTR) continue;
      if (n > 0) m.text.append(piece, static_cast<std::size_t>(n));
      const bool whole = !m.text.empty() && m.text.back() == '\n';
      if (n > 0 && !whole) continue;
      const std::size_t which = m.piece;
      std::string line = std::move(m.text), death;
      m.text.clear();
      m.busy = false;
      if (!whole) {
        line.clear();
        death = Crew::end(m);
        crew.start(m);
      }
      ++done;
      take(which, line, death);
    }
  }
}

}  // namespace cli::inference
