// Preloaded into the program by tests/faults/campaign: makes one call fail, or every call from one on.
//   FAULT_CALL   write, open, rename, fsync, fork or malloc
//   FAULT_AT     the first call that fails, counted from 1 in each process
//   FAULT_ON     once, or on: from then on
//   FAULT_FILE   how often each process makes each of these calls, a line of six numbers appended; for a first run without
//   FAULT_CALL
// Only calls on files that are written count: the loader's and the libraries' own reading is not what is tested here.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

namespace {

enum Call { kWrite, kOpen, kRename, kFsync, kMalloc, kFork, kCalls };
constexpr const char* kNames[kCalls] = {"write", "open", "rename", "fsync", "malloc", "fork"};

struct Fault {
  int call = kCalls;  // that fails; none
  long at = 0;
  bool on = false;
  bool read = false;
};
Fault fault;
std::atomic<long> calls[kCalls];
pid_t counted_in = 0;
// libraries allocate while they are loaded; what they do without is not the program's to answer
bool in_main = false;

void read_wish() {
  fault.read = true;
  counted_in = getpid();
  if (const char* name = getenv("FAULT_CALL"))
    for (fault.call = 0; fault.call < kCalls && strcmp(name, kNames[fault.call]) != 0;) ++fault.call;
  if (const char* at = getenv("FAULT_AT")) fault.at = atol(at);
  const char* on = getenv("FAULT_ON");
  fault.on = on && strcmp(on, "on") == 0;
}

/// Whether this call of that kind is the one to fail. A forked process counts on its own.
bool fails(Call call) {
  if (!in_main) return false;
  if (!fault.read) read_wish();
  if (fault.at > 0 && call != fault.call) return false;
  if (const pid_t here = static_cast<pid_t>(syscall(SYS_getpid)); here != counted_in) {
    counted_in = here;
    for (auto& count : calls) count = 0;
  }
  const long n = ++calls[call];
  return fault.at > 0 && (fault.on ? n >= fault.at : n == fault.at);
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool for_writing(int flags) {
  return (flags & O_ACCMODE) != O_RDONLY;
}

// malloc is needed while its successor is looked up
alignas(16) char early[1 << 16];
std::size_t early_used = 0;
bool is_early(const void* p) {
  return p >= early && p < early + sizeof early;
}
void* early_malloc(std::size_t size) {
  void* p = early + early_used;
  early_used += (size + 15) / 16 * 16;
  return p;
}

using Malloc = void* (*)(std::size_t);
Malloc real_malloc = nullptr;
thread_local bool looking_up = false;

/// Counts of a run without faults: one line a process, at its end.
void report_calls() {
  const char* file = getenv("FAULT_FILE");
  if (!file || counted_in != static_cast<pid_t>(syscall(SYS_getpid))) return;
  char line[160];
  int size = 0;
  for (const auto& count : calls) size += snprintf(line + size, sizeof line - size, "%ld ", count.load());
  line[size - 1] = '\n';
  const long to = syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (to < 0) return;
  if (syscall(SYS_write, to, line, size) < 0) return;
  syscall(SYS_close, to);
}
struct Report {
  ~Report() { report_calls(); }
} report;

}  // namespace

int (*real_main)(int, char**, char**) = nullptr;
int watched_main(int argc, char** argv, char** environment) {
  in_main = true;
  return real_main(argc, argv, environment);
}

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(), void (*end)(),
                      void* stack) {
  using Start = int (*)(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);
  real_main = main;
  return next<Start>("__libc_start_main")(watched_main, argc, argv, init, fini, end, stack);
}

ssize_t write(int file, const void* data, size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (file > 2 && fails(kWrite)) {
    errno = ENOSPC;
    return -1;
  }
  return real(file, data, size);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  static const auto real = next<ssize_t (*)(int, const struct iovec*, int)>("writev");
  if (file > 2 && fails(kWrite)) {
    errno = ENOSPC;
    return -1;
  }
  return real(file, parts, count);
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
  va_end(more);
  if (for_writing(flags) && fails(kOpen)) {
    errno = EMFILE;
    return -1;
  }
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
  va_end(more);
  return open(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  static const auto real = next<FILE* (*)(const char*, const char*)>("fopen");
  if (mode[0] != 'r' && fails(kOpen)) {
    errno = EMFILE;
    return nullptr;
  }
  return real(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  return fopen(path, mode);
}

// what stdio writes at last it writes past the calls above
size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
  static const auto real = next<size_t (*)(const void*, size_t, size_t, FILE*)>("fwrite");
  if (file != stdout && file != stderr && fails(kWrite)) {
    errno = ENOSPC;
    return 0;
  }
  return real(data, size, count, file);
}
int fclose(FILE* file) {
  static const auto real = next<int (*)(FILE*)>("fclose");
  const int flags = fcntl(fileno(file), F_GETFL);
  const int result = real(file);
  if (flags >= 0 && for_writing(flags) && fails(kWrite)) {
    errno = ENOSPC;
    return EOF;
  }
  return result;
}

int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  if (fails(kRename)) {
    errno = EIO;
    return -1;
  }
  return real(from, to);
}

int fsync(int file) {
  static const auto real = next<int (*)(int)>("fsync");
  if (fails(kFsync)) {
    errno = EIO;
    return -1;
  }
  return real(file);
}

// how what was forked ends: nothing at exit runs there
void _exit(int code) {
  report_calls();
  syscall(SYS_exit_group, code);
  __builtin_unreachable();
}

pid_t fork() {
  static const auto real = next<pid_t (*)()>("fork");
  if (fails(kFork)) {
    errno = EAGAIN;
    return -1;
  }
  return real();
}

void* malloc(size_t size) {
  if (!real_malloc) {
    if (looking_up) return early_malloc(size);
    looking_up = true;
    real_malloc = next<Malloc>("malloc");
    looking_up = false;
  }
  if (fails(kMalloc)) {
    errno = ENOMEM;
    return nullptr;
  }
  return real_malloc(size);
}

void free(void* p) {
  static const auto real = next<void (*)(void*)>("free");
  if (!is_early(p)) real(p);
}

}  // extern "C"
