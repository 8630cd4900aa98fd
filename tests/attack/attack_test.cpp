// An attacker in the cage: tests/attack/attacker.cpp runs in place of the importer, as whoever runs this and as nobody, with
// Landlock and on a kernel that seems to have none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <tuple>

#include "scenes/loader/cage.h"

namespace {

namespace fs = std::filesystem;

constexpr unsigned kNobody = 65534;

class Attack : public testing::TestWithParam<std::tuple<bool, bool>> {
 protected:
  Attack() {
    std::string pattern = (fs::temp_directory_path() / "crashreel_attack_XXXXXX").string();
    root_ = mkdtemp(pattern.data());
    fs::create_directories(root_ / "inside");
    fs::create_directories(root_ / "outside");
    std::ofstream(root_ / "inside/attack.obj") << "v 0 0 0\n";
    std::ofstream(root_ / "inside/victim") << "precious";
    std::ofstream(root_ / "outside/secret.mtl") << "newmtl paint\n";
    fs::create_symlink("../outside/secret.mtl", root_ / "inside/link.mtl");
    fs::create_directory_symlink("../outside", root_ / "inside/way");
    mkfifo((root_ / "inside/pipe.mtl").c_str(), 0666);
    for (const char* folder : {"", "inside", "outside"}) fs::permissions(root_ / folder, fs::perms::all);
    for (const char* file : {"inside/attack.obj", "inside/victim", "outside/secret.mtl"})
      fs::permissions(root_ / file, fs::perms(0666));
  }
  ~Attack() override { fs::remove_all(root_); }

  fs::path root_;
};

/// What the kernel says to Landlock's first call from now on: that it has none.
bool hide_landlock() {
  scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
  const bool hidden = filter && seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), 444, 0) == 0 && seccomp_load(filter) == 0;
  seccomp_release(filter);
  return hidden;
}

/// In a process of its own: who it is and what its kernel has is not undone.
[[noreturn]] void attack(const fs::path& root, bool as_nobody, bool with_landlock, const fs::path& report) {
  std::ofstream out(report);
  setenv("SECRET", "of the parent", 1);
  if (chdir((root / "inside").c_str()) != 0) _exit(2);
  if (as_nobody && (setresgid(kNobody, kNobody, kNobody) != 0 || setresuid(kNobody, kNobody, kNobody) != 0)) _exit(3);
  prctl(PR_SET_DUMPABLE, 1);  // changing the user forbade to ask where our own program is
  if (!with_landlock && !hide_landlock()) _exit(4);
  const scenes::CageAnswer answer = scenes::ask_cage(root / "inside/attack.obj", root / "inside");
  out << answer.problem << "|" << answer.warning;
  out.close();
  _exit(0);
}

}  // namespace

TEST_P(Attack, NothingSucceeds) {
  const auto [as_nobody, with_landlock] = GetParam();
  if (as_nobody && geteuid() != 0) return;  // who runs this is a user already
  const fs::path report = root_ / "report";
  const pid_t child = fork();
  if (child == 0) attack(root_, as_nobody, with_landlock, report);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_EQ(WEXITSTATUS(status), 0);
  std::ostringstream said;
  said << std::ifstream(report).rdbuf();
  EXPECT_THAT(said.str(), testing::MatchesRegex("[0-9]+ tries, succeeded:\\|.*"));
  EXPECT_GE(std::atoi(said.str().c_str()), 40);
  // a wall that is missing is told
  const bool kernel_has_it = syscall(444, nullptr, 0, 1) >= 1;
  EXPECT_EQ(said.str().find("Landlock") == std::string::npos, with_landlock && kernel_has_it) << said.str();
  std::ostringstream victim;
  victim << std::ifstream(root_ / "inside/victim").rdbuf();
  EXPECT_EQ(victim.str(), "precious");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "inside"), fs::directory_iterator{}), 5);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, Attack, testing::Combine(testing::Bool(), testing::Bool()));
