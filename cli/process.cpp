#include "cli/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "cli/exit.h"

namespace cli {
namespace {

// A long call (an import, the solve of a heavy step, an encoder at work) may not look in time. Everything on the disk is whole at
// every instant, so after this the process may end from within the handler.
constexpr unsigned kPatience = 1;  // [s] of the two a batch system is promised

volatile sig_atomic_t asked_to_stop = 0;

void end_now(int) {
  _exit(128 + asked_to_stop);
}

void note(int signal) {
  // asked twice: somebody means it
  if (asked_to_stop != 0) end_now(signal);
  asked_to_stop = signal;
  alarm(kPatience);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // no half-written row because of a signal
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

/// A descriptor that was closed would be given to the next file opened, and messages would land in that file.
void fill_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    // results that nobody can read are an error, met when they are written; messages are not
    const int filler = open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    if (filler >= 0 && filler != descriptor) {
      dup2(filler, descriptor);
      close(filler);
    }
  }
}

ssize_t write_message(void*, const char* text, size_t size) {
  for (size_t sent = 0; sent < size;) {
    const ssize_t n = ::write(STDERR_FILENO, text + sent, size - sent);
    if (n <= 0) break;
    sent += static_cast<size_t>(n);
  }
  return static_cast<ssize_t>(size);
}

/// Messages that cannot be written are lost, not fatal: a log on a full disk must not cost the film.
void make_messages_harmless() {
  cookie_io_functions_t functions{};
  functions.write = write_message;
  if (std::FILE* messages = fopencookie(nullptr, "w", functions)) {
    std::setvbuf(messages, nullptr, _IONBF, 0);
    stderr = messages;
  }
}

/// Libraries that promise not to throw run out of memory all the same; then no catch is reached.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    constexpr char kMessage[] = "crashreel: not enough memory\n";
    if (::write(STDERR_FILENO, kMessage, sizeof kMessage - 1) < 0) _exit(kMachineFailed);
    _exit(kMachineFailed);
  } catch (...) {
  }
  std::abort();
}

}  // namespace

Interrupted::Interrupted(int number)
    : std::runtime_error(fmt::format("stopped by {}; --resume goes on from here", number == SIGINT ? "SIGINT" : "SIGTERM")),
      signal(number) {}

void prepare_process() {
  std::set_terminate(end_without_memory);
  fill_standard_descriptors();
  make_messages_harmless();
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  handle(SIGALRM, end_now);
  for (const int stop : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    sigaction(stop, nullptr, &before);
    // who started us with nohup or in the background of a script wants it left alone
    if (before.sa_handler != SIG_IGN) handle(stop, note);
  }
}

bool interrupted() {
  return asked_to_stop != 0;
}

void check_interrupted() {
  if (interrupted()) throw Interrupted(asked_to_stop);
}

}  // namespace cli
