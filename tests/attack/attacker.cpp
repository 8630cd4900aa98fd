// What runs in the cage after a foreign mesh has taken the importer over: every way out that somebody has shown or that we know of.
// Linked into a worker in place of the importer; says which tries succeeded.
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

#include "scenes/cage/files.h"
#include "scenes/cage/tasks.h"

namespace scenes::cage {
namespace {

struct Try {
  const char* name;
  bool (*succeeds)();
};

template <class... Arguments>
bool call(long number, Arguments... arguments) {
  return syscall(number, arguments...) >= 0;
}
bool opens(const char* path, int flags) {
  return call(SYS_openat, AT_FDCWD, path, flags, 0666);
}
std::string of_parent(const char* file) {
  return "/proc/" + std::to_string(syscall(SYS_getppid)) + "/" + file;
}
char word[64] = "bytes";

const Try kTries[] = {
    {"open /etc/passwd", [] { return opens("/etc/passwd", O_RDONLY); }},
    {"open /etc/shadow", [] { return opens("/etc/shadow", O_RDONLY); }},
    {"open the folder", [] { return opens(".", O_RDONLY | O_DIRECTORY); }},
    {"open the mesh by itself", [] { return opens("attack.obj", O_RDONLY); }},
    {"open a device", [] { return opens("/dev/zero", O_RDONLY); }},
    {"open a path only", [] { return opens("/", O_PATH); }},
    {"open for writing", [] { return opens("victim", O_WRONLY | O_TRUNC); }},
    {"create", [] { return opens("planted", O_WRONLY | O_CREAT); }},
    {"create without a name", [] { return opens("/tmp", O_WRONLY | O_TMPFILE); }},
    {"openat2", [] { return call(437, AT_FDCWD, "/etc/passwd", word, 24); }},
    {"open_by_handle_at", [] { return call(SYS_open_by_handle_at, AT_FDCWD, word, O_RDONLY); }},
    {"mkdir", [] { return call(SYS_mkdirat, AT_FDCWD, "planted_folder", 0777); }},
    {"unlink", [] { return call(SYS_unlinkat, AT_FDCWD, "victim", 0); }},
    {"rename", [] { return call(SYS_renameat2, AT_FDCWD, "victim", AT_FDCWD, "moved", 0); }},
    {"truncate", [] { return call(SYS_truncate, "victim", 0); }},
    {"chmod", [] { return call(SYS_fchmodat, AT_FDCWD, "victim", 0777); }},
    {"chown", [] { return call(SYS_fchownat, AT_FDCWD, "victim", 1, 1, 0); }},
    {"utimes", [] { return call(SYS_utimensat, AT_FDCWD, "victim", nullptr, 0); }},
    {"setxattr", [] { return call(SYS_setxattr, "victim", "user.planted", "1", 1, 0); }},
    {"symlink", [] { return call(SYS_symlinkat, "/etc", AT_FDCWD, "planted_link"); }},
    {"hard link", [] { return call(SYS_linkat, AT_FDCWD, "victim", AT_FDCWD, "second", 0); }},
    {"mknod", [] { return call(SYS_mknodat, AT_FDCWD, "planted_pipe", S_IFIFO | 0666, 0); }},
    {"stat", [] { return call(SYS_newfstatat, AT_FDCWD, "/etc/passwd", word, 0); }},
    {"access", [] { return call(SYS_faccessat, AT_FDCWD, "/etc/passwd", R_OK); }},
    {"readlink", [] { return call(SYS_readlinkat, AT_FDCWD, "/proc/self/exe", word, sizeof word); }},
    {"getcwd", [] { return call(SYS_getcwd, word, sizeof word); }},
    {"chdir", [] { return call(SYS_chdir, "/"); }},
    {"chroot", [] { return call(SYS_chroot, "."); }},
    {"mount", [] { return call(SYS_mount, "none", "/mnt", "tmpfs", 0, nullptr); }},
    {"umount", [] { return call(SYS_umount2, "/proc", MNT_DETACH); }},
    {"execve", [] { return call(SYS_execve, "/bin/true", nullptr, nullptr); }},
    {"execveat", [] { return call(SYS_execveat, AT_FDCWD, "/bin/true", nullptr, nullptr, 0); }},
    {"fork",
     [] {
       const long pid = syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0);
       if (pid == 0) _exit(0);
       return pid > 0;
     }},
    {"clone3", [] { return call(SYS_clone3, word, 64); }},
    {"unshare user", [] { return call(SYS_unshare, CLONE_NEWUSER); }},
    {"unshare net", [] { return call(SYS_unshare, CLONE_NEWNET); }},
    {"setns", [] { return call(SYS_setns, 0, 0); }},
    {"kill parent", [] { return call(SYS_kill, syscall(SYS_getppid), 0); }},
    {"kill process 1", [] { return call(SYS_kill, 1, 0); }},
    {"kill all", [] { return call(SYS_kill, -1, 0); }},
    {"tgkill", [] { return call(SYS_tgkill, 1, 1, 0); }},
    {"pidfd_open", [] { return call(SYS_pidfd_open, 1, 0); }},
    {"ask for the parent", [] { return syscall(SYS_getppid) > 0; }},
    {"ptrace parent", [] { return call(SYS_ptrace, PTRACE_ATTACH, syscall(SYS_getppid), 0, 0); }},
    {"process_vm_readv",
     [] {
       iovec here{word, 8};
       return call(SYS_process_vm_readv, 1, &here, 1, &here, 1, 0);
     }},
    {"memory of the parent", [] { return opens(of_parent("mem").c_str(), O_RDWR); }},
    {"environment of the parent", [] { return opens(of_parent("environ").c_str(), O_RDONLY); }},
    {"own environment", [] { return environ != nullptr && environ[0] != nullptr; }},
    {"inherited descriptors",
     [] {
       bool any = false;
       for (int other = 4; other < 1024; ++other) any = any || syscall(SYS_read, other, word, 0) >= 0;
       return any;
     }},
    {"duplicate a descriptor", [] { return call(SYS_dup, 3); }},
    {"write to standard output", [] { return call(SYS_write, 1, "x", 1); }},
    {"type into the terminal", [] { return call(SYS_ioctl, 0, TIOCSTI, "x"); }},
    {"UDP", [] { return call(SYS_socket, AF_INET, SOCK_DGRAM, 0); }},
    {"TCP", [] { return call(SYS_socket, AF_INET, SOCK_STREAM, 0); }},
    {"UNIX socket", [] { return call(SYS_socket, AF_UNIX, SOCK_STREAM, 0); }},
    {"netlink", [] { return call(SYS_socket, AF_NETLINK, SOCK_RAW, 0); }},
    {"socketpair", [] { return call(SYS_socketpair, AF_UNIX, SOCK_STREAM, 0, word); }},
    {"hand a descriptor out",
     [] {
       msghdr message{};
       return call(SYS_sendmsg, 3, &message, 0);
     }},
    {"io_uring", [] { return call(SYS_io_uring_setup, 1, word); }},
    {"shared memory", [] { return call(SYS_shmget, 0, 4096, 01600); }},
    {"message queue", [] { return call(SYS_msgget, 0, 01600); }},
    {"semaphores", [] { return call(SYS_semget, 0, 1, 01600); }},
    {"add_key", [] { return call(SYS_add_key, "user", "planted", "x", 1, -4); }},
    {"keyctl", [] { return call(SYS_keyctl, 0, -3, 1); }},
    {"memfd", [] { return call(SYS_memfd_create, "x", 0); }},
    {"userfaultfd", [] { return call(SYS_userfaultfd, 0); }},
    {"bpf", [] { return call(SYS_bpf, 0, word, 48); }},
    {"perf_event_open", [] { return call(SYS_perf_event_open, word, 0, -1, -1, 0); }},
    {"inotify", [] { return call(SYS_inotify_init1, 0); }},
    {"memory that executes",
     [] { return mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED; }},
    {"memory made executable",
     [] {
       void* page = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
       return page == MAP_FAILED || mprotect(page, 4096, PROT_READ | PROT_EXEC) == 0;
     }},
    {"outlive the parent", [] { return prctl(PR_SET_PDEATHSIG, 0) == 0; }},
    {"setsid", [] { return call(SYS_setsid); }},
    {"setpgid", [] { return call(SYS_setpgid, 0, 0); }},
    {"raise a limit", [] { return call(SYS_prlimit64, 0, RLIMIT_CPU, nullptr, word); }},
    {"limits of the parent", [] { return call(SYS_prlimit64, 1, RLIMIT_CPU, nullptr, word); }},
    {"setuid", [] { return call(SYS_setuid, 0); }},
    {"capset", [] { return call(SYS_capset, word, word); }},
    {"personality", [] { return call(SYS_personality, 0xffffffff); }},
    {"sleep",
     [] {
       const timespec moment{0, 1};
       return call(SYS_nanosleep, &moment, nullptr);
     }},
    {"ask for /etc/passwd", [] { return fetch("/etc/passwd").has_value(); }},
    {"ask for a file outside", [] { return fetch("../outside/secret.mtl").has_value(); }},
    {"ask through a link to a file", [] { return fetch("link.mtl").has_value(); }},
    {"ask through a link to a folder", [] { return fetch("way/secret.mtl").has_value(); }},
    {"ask for a pipe", [] { return fetch("pipe.mtl").has_value(); }},
    {"ask for another ending", [] { return fetch("victim").has_value(); }},
    {"ask for the folder", [] { return fetch(".").has_value(); }},
    {"ask for a name with a zero in it", [] { return fetch(std::string("attack.obj\0.mtl", 15)).has_value(); }},
    {"ask for the parent's memory", [] { return fetch("/proc/self/mem").has_value(); }},
};

}  // namespace

std::string mesh(const std::string& name) {
  if (!fetch(name)) return "Ethe mesh itself was not handed over";
  std::string out = "E" + std::to_string(std::size(kTries)) + " tries, succeeded:";
  for (const Try& it : kTries)
    if (it.succeeds()) out += std::string(" [") + it.name + "]";
  return out;
}

}  // namespace scenes::cage
