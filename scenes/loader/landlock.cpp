// Landlock by its system calls (Linux 5.13, Documentation/userspace-api/landlock.rst): Debian 12's C library has no functions for
// it, and the constants are few enough to stand here, independent of the kernel headers the program is built with.
#include "scenes/loader/landlock.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace scenes {
namespace {

// the same numbers on every architecture
constexpr long kCreateRuleset = 444;
constexpr long kAddRule = 445;
constexpr long kRestrictSelf = 446;
constexpr std::uint32_t kAskVersion = 1;
constexpr int kPathBeneath = 1;
constexpr std::uint64_t kReadFile = 1u << 2;
constexpr std::uint64_t kReadFolder = 1u << 3;

struct Ruleset {
  std::uint64_t handled_files = 0;
  std::uint64_t handled_network = 0;  // from version 4 on
};
struct [[gnu::packed]] PathRule {
  std::uint64_t allowed = 0;
  std::int32_t folder = -1;
};

/// Every right on files that this version of Landlock knows; what is handled and not allowed is forbidden.
std::uint64_t all_file_rights(long version) {
  std::uint64_t rights = (1u << 13) - 1;  // version 1: execute to make_sym
  if (version >= 2) rights |= 1u << 13;   // refer
  if (version >= 3) rights |= 1u << 14;   // truncate
  if (version >= 5) rights |= 1u << 15;   // ioctl_dev
  return rights;
}

bool allow_reading(long ruleset, const std::filesystem::path& root) {
  PathRule rule;
  rule.allowed = kReadFile | kReadFolder;
  rule.folder = open(root.empty() ? "." : root.c_str(), O_PATH | O_CLOEXEC);
  if (rule.folder < 0) return false;
  const bool added = syscall(kAddRule, ruleset, kPathBeneath, &rule, 0) == 0;
  close(rule.folder);
  return added;
}

}  // namespace

bool confine_to(const std::filesystem::path& root) {
  const long version = syscall(kCreateRuleset, nullptr, 0, kAskVersion);
  if (version < 1) return false;
  Ruleset rules;
  rules.handled_files = all_file_rights(version);
  if (version >= 4) rules.handled_network = 3;  // bind and connect
  const std::size_t size = version >= 4 ? sizeof rules : sizeof rules.handled_files;
  const long ruleset = syscall(kCreateRuleset, &rules, size, 0);
  if (ruleset < 0) return false;
  // without this an unprivileged process may not restrict itself
  const bool confined =
      allow_reading(ruleset, root) && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(kRestrictSelf, ruleset, 0) == 0;
  close(static_cast<int>(ruleset));
  return confined;
}

}  // namespace scenes
