#include "cli/process.h"

#include <execinfo.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <new>
#include <string>
#include <string_view>

#include "cli/exit.h"
#include "render/late_library.h"

namespace cli {
namespace {

// A long call (an import, the solve of a heavy step, an encoder at work) may not look in time. Everything on the disk is whole at
// every instant, so after this the process may end from within the handler.
constexpr unsigned kPatience = 1;  // [s] of the two a batch system is promised

volatile sig_atomic_t asked_to_stop = 0;
pid_t program = 0;  // workers inherit the handlers, and leave last words and files to their parent

// All that a handler may touch is prepared beforehand: it neither allocates nor formats.
std::array<char, 512> kept_text = {"nothing was kept"};
std::array<std::atomic<const char*>, 64> passing_files = {};

const char* name_of(int stop) {
  return stop == SIGINT ? "SIGINT" : stop == SIGHUP ? "SIGHUP" : "SIGTERM";
}

/// What a handler leaves behind in place of destructors.
void last_words(std::initializer_list<const char*> texts) {
  for (const char* text : texts)
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  if (getpid() != program) return;
  for (const auto& file : passing_files)
    if (const char* path = file.load()) unlink(path);
}

void end_now(int) {
  if (asked_to_stop == 0) return;  // an alarm that is not ours
  if (getpid() == program) last_words({"crashreel: stopped by ", name_of(asked_to_stop), "; ", kept_text.data(), "\n"});
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

/// 0 when all was written.
int write_all(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(to, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return errno;
    text.remove_prefix(static_cast<size_t>(n));
  }
  return 0;
}

/// A standard stream as the C library writes to it.
struct Stream {
  int descriptor;
  bool may_fail;          // results that are lost are an error; messages are lost in silence
  bool after_c2 = false;  // the last byte began one of U+0080 to U+00BF
};
Stream results{STDOUT_FILENO, true}, messages{STDERR_FILENO, false};

/// Titles and names are a stranger's: what would move a terminal's cursor, clear it or type into it is shown as a question mark.
std::string harmless(Stream& stream, std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f || (stream.after_c2 && byte >= 0x80 && byte < 0xa0)) c = '?';
    stream.after_c2 = byte == 0xc2;
  }
  return out;
}

ssize_t write_text(void* cookie, const char* text, size_t size) {
  Stream& stream = *static_cast<Stream*>(cookie);
  const int problem = write_all(stream.descriptor, harmless(stream, {text, size}));
  if (problem == 0 || !stream.may_fail) return static_cast<ssize_t>(size);
  errno = problem;
  return 0;
}

/// Messages that cannot be written are lost, not fatal: a log on a full disk must not cost the film.
void take_over_streams() {
  cookie_io_functions_t functions{};
  functions.write = write_text;
  if (std::FILE* stream = fopencookie(&messages, "w", functions)) {
    std::setvbuf(stream, nullptr, _IONBF, 0);
    stderr = stream;
  }
  if (std::FILE* stream = fopencookie(&results, "w", functions)) stdout = stream;
}

[[noreturn]] void tell_of_memory() {
  last_words({"crashreel: not enough memory\n"});
  _exit(kMachineFailed);
}

/// Libraries that promise not to throw run out of memory all the same; then no catch is reached.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    tell_of_memory();
  } catch (...) {
  }
  std::abort();
}

/// libgcrypt, which libavformat brings along, aborts in its constructor without memory, and OSMesa crashes.
[[noreturn]] void end_failed_load(int) {
  tell_of_memory();
}

}  // namespace

Interrupted::Interrupted(int number)
    : std::runtime_error(fmt::format("stopped by {}; {}", name_of(number), kept_text.data())), signal(number) {}

void tell_when_stopped(const std::string& kept) {
  const std::size_t length = kept.copy(kept_text.data(), kept_text.size() - 1);
  kept_text[length] = '\0';
}

void remove_when_stopped(const char* path) {
  for (auto& file : passing_files)
    if (const char* none = nullptr; file.compare_exchange_strong(none, path)) return;
}

void keep_when_stopped(const char* path) {
  for (auto& file : passing_files)
    if (const char* held = path; file.compare_exchange_strong(held, nullptr)) return;
}

void prepare_process() {
  // A thread of the GL driver that ends has the C library load libgcc, and abort where memory has run out by then. So it is loaded
  // now: man 3 backtrace, "Notes".
  void* frame = nullptr;
  backtrace(&frame, 1);
  std::set_terminate(end_without_memory);
  render::end_failed_load_by(end_failed_load);
  fill_standard_descriptors();
  take_over_streams();
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  program = getpid();
  handle(SIGALRM, end_now);
  for (const int stop : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(stop, nullptr, &before);
    // who started us with nohup or in the background of a script wants it left alone
    if (before.sa_handler != SIG_IGN) handle(stop, note);
  }
}

void write_to_terminal(const std::string& text) {
  write_all(STDERR_FILENO, text);
}

bool interrupted() {
  return asked_to_stop != 0;
}

void check_interrupted() {
  if (interrupted()) throw Interrupted(asked_to_stop);
}

}  // namespace cli
