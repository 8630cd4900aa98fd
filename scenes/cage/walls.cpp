// Four walls, each of which holds by itself for what it covers: limits, no rights of root, Landlock without a single rule (nothing
// is allowed), and a list of the system calls that computing takes.
#include "scenes/cage/walls.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

#include "scenes/cage/protocol.h"

namespace scenes::cage {
namespace {

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

void set_limits(const Limits& limits) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_NPROC, 0);
  limit(RLIMIT_NOFILE, 16);
  limit(RLIMIT_CPU, limits.cpu_time);
  limit(RLIMIT_AS, limits.memory);
}

/// Root without its rights is a user like others, to whom RLIMIT_NPROC applies.
void drop_rights() {
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct none[2] = {};
  syscall(SYS_capset, &head, none);
  prctl(PR_SET_DUMPABLE, 0);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);  // without this an unprivileged process may not restrict itself
}

// Landlock by its system calls (Linux 5.13, Documentation/userspace-api/landlock.rst): Debian 12's C library has no functions for
// it, and the constants are few enough to stand here, independent of the kernel headers the program is built with.
constexpr long kCreateRuleset = 444, kRestrictSelf = 446;
constexpr std::uint32_t kAskVersion = 1;
struct Ruleset {
  std::uint64_t files = 0;
  std::uint64_t network = 0;  // from version 4 on
  std::uint64_t scopes = 0;   // from version 6 on: abstract UNIX sockets, signals
};

/// Every right that this version of Landlock knows; what is handled and not allowed is forbidden, and nothing is allowed.
bool raise_landlock() {
  const long version = syscall(kCreateRuleset, nullptr, 0, kAskVersion);
  if (version < 1) return false;
  Ruleset rules;
  rules.files = (1u << 13) - 1;  // version 1: execute to make_sym
  if (version >= 2) rules.files |= 1u << 13;
  if (version >= 3) rules.files |= 1u << 14;
  if (version >= 5) rules.files |= 1u << 15;
  if (version >= 4) rules.network = 3;
  if (version >= 6) rules.scopes = 3;
  const std::size_t size = sizeof(std::uint64_t) * (version >= 6 ? 3 : version >= 4 ? 2 : 1);
  const long ruleset = syscall(kCreateRuleset, &rules, size, 0);
  if (ruleset < 0) return false;
  const bool raised = syscall(kRestrictSelf, ruleset, 0) == 0;
  close(static_cast<int>(ruleset));
  return raised;
}

/// Everything that is not on the list is refused. Memory never becomes executable; what is written goes to the parent.
bool raise_seccomp() {
  scmp_filter_ctx list = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (!list) return false;
  bool good = true;
  for (const int call : {SCMP_SYS(read), SCMP_SYS(close), SCMP_SYS(lseek), SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap),
                         SCMP_SYS(madvise), SCMP_SYS(futex), SCMP_SYS(clock_gettime), SCMP_SYS(getrandom), SCMP_SYS(sched_yield),
                         SCMP_SYS(rt_sigreturn), SCMP_SYS(exit), SCMP_SYS(exit_group)})
    good = good && seccomp_rule_add(list, SCMP_ACT_ALLOW, call, 0) == 0;
  for (const int call : {SCMP_SYS(write), SCMP_SYS(recvmsg)})
    good = good && seccomp_rule_add(list, SCMP_ACT_ALLOW, call, 1, SCMP_A0(SCMP_CMP_EQ, kSocket)) == 0;
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mprotect)})
    good = good && seccomp_rule_add(list, SCMP_ACT_ALLOW, call, 1, SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0)) == 0;
  good = good && seccomp_load(list) == 0;
  seccomp_release(list);
  return good;
}

}  // namespace

std::uint32_t raise_walls(const Limits& limits) {
  set_limits(limits);
  drop_rights();
  std::uint32_t walls = 0;
  if (raise_landlock()) walls |= Wall::landlock;
  if (raise_seccomp()) walls |= Wall::seccomp;
  return walls;
}

}  // namespace scenes::cage
