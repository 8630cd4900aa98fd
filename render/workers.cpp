#include "render/workers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <utility>
#include <vector>

#include "render/error.h"

namespace render {
namespace {

constexpr int kLook = 100;  // [ms] between two looks around

/// In the child, before anything else.
void bind_to(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(4);  // the parent died before the line above could bind us to it
}

int wait_for(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// The reading end of what a task says.
class Pipe {
 public:
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw RenderError(fmt::format("starting a process: {}", std::strerror(errno)));
    in_ = ends[0];
    out_ = ends[1];
  }
  ~Pipe() {
    close(in_);
    close_out();
  }
  Pipe(Pipe&& other) noexcept : in_(std::exchange(other.in_, -1)), out_(std::exchange(other.out_, -1)) {}
  Pipe& operator=(Pipe&& other) noexcept {
    std::swap(in_, other.in_);
    std::swap(out_, other.out_);
    return *this;
  }
  int in() const { return in_; }
  void close_out() {
    if (out_ >= 0) close(std::exchange(out_, -1));
  }
  bool write_all(const std::string& text) const {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t n = write(out_, text.data() + sent, text.size() - sent);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }

 private:
  int in_ = -1, out_ = -1;
};

struct Running {
  int task, place;
  Pipe pipe;
  Worker worker;
  std::string message{};
};

/// Takes what came; false at the end of it.
bool take(Running& from) {
  char piece[1 << 16];
  const ssize_t n = read(from.pipe.in(), piece, sizeof piece);
  if (n > 0) from.message.append(piece, static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && (errno == EINTR || errno == EAGAIN));
}

int life_of(const std::function<std::string(int, int)>& task, int number, int place, const Pipe& pipe) {
  int code = 0;
  try {
    if (!pipe.write_all(task(number, place))) code = 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "crashreel: {}\n", error.what());
    code = 1;
  }
  std::fflush(stderr);
  return code;
}

}  // namespace

Worker::Worker(const std::function<int()>& life) {
  std::fflush(nullptr);  // what is buffered is written once
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) throw RenderError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (pid_ > 0) return;
  bind_to(parent);
  _exit(life());
}

Worker::~Worker() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  wait_for(pid_);
}

Worker::Worker(Worker&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}

Worker& Worker::operator=(Worker&& other) noexcept {
  std::swap(pid_, other.pid_);
  return *this;
}

int Worker::wait() {
  return wait_for(std::exchange(pid_, -1));
}

bool Worker::has_ended(int& status) {
  if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) != pid_) return false;
  pid_ = -1;
  return true;
}

std::string ending(int status) {
  return WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : fmt::format("exit code {}", WEXITSTATUS(status));
}

Workers::Workers(int jobs, std::function<void()> look_around) : jobs_(std::max(1, jobs)), look_around_(std::move(look_around)) {}

void Workers::run(int count, const std::function<std::string(int, int)>& task,
                  const std::function<void(const TaskResult&)>& on_result) {
  std::vector<int> places;
  for (int place = jobs_; place > 0;) places.push_back(--place);
  std::vector<Running> running;
  for (int next = 0; next < count || !running.empty();) {
    for (; next < count && !places.empty(); ++next) {
      Pipe pipe;
      const int place = places.back();
      Worker worker([&] { return life_of(task, next, place, pipe); });
      pipe.close_out();
      places.pop_back();
      running.push_back({next, place, std::move(pipe), std::move(worker)});
    }
    std::vector<pollfd> ready;
    for (const Running& r : running) ready.push_back({r.pipe.in(), POLLIN, 0});
    const int events = poll(ready.data(), ready.size(), kLook);
    if (look_around_) look_around_();
    for (std::size_t i = events > 0 ? running.size() : 0; i-- > 0;) {
      if (ready[i].revents == 0 || take(running[i])) continue;
      Running ended = std::move(running[i]);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      places.push_back(ended.place);
      on_result({ended.task, ended.worker.wait(), std::move(ended.message)});
    }
  }
}

}  // namespace render
