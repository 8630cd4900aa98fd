// Runs small jobs of the program under injected faults and kills, and holds what they leave behind against an undisturbed run:
//   fault_campaign PROGRAM SHIM --faults N --kills N [--seed N]  at random
//   fault_campaign PROGRAM SHIM --in-turn CALL [--every N]       each (N-th) call of a kind of each job; again for another kind
// Promises checked after every disturbance: the program ends by itself with an exit code it documents (faults); a file under a
// final name is the file of an undisturbed run; exit code 0 means that none is missing; the same command with --resume then ends
// with exactly the files of an undisturbed run. A third of the kills strike a second time, during that --resume.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace fs = std::filesystem;

namespace {

constexpr const char* kScene = R"(title = "Ball"
[simulation]
duration = "0.64 s"
stop_at_rest = false
[[body]]
name = "ball"
mass = "2 kg"
axes = "0.1 0.1 0.1 m"
position = "0 0 0.3 m"
velocity = "1 0 0 m/s"
friction = 0.5
[[camera]]
name = "side"
position = "0 -3 1 m"
target = "0 0 0.2 m"
)";

constexpr int kPatience = 60;  // [s] a job takes about one

struct Job {
  std::string name;
  std::vector<std::string> arguments;
  long calls[6] = {};  // of the undisturbed run, most of any one process, in the order of kCalls
};
const char* const kCalls[] = {"write", "open", "rename", "fsync", "malloc", "fork"};

using Files = std::map<std::string, std::string>;

/// What lies below a folder, by name; times of the clock taken out of summary.json.
Files files_in(const fs::path& folder) {
  Files out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    if (entry.path().filename() == "summary.json") {
      std::istringstream lines(bytes);
      bytes.clear();
      for (std::string line; std::getline(lines, line);) {
        bool timed = false;
        for (const char* key : {"\"wall_s\"", "\"steps_per_s\"", "\"realtime_factor\""})
          timed = timed || line.find(key) != std::string::npos;
        if (line.find("\"longest_step\": {") != std::string::npos)
          while (std::getline(lines, line) && line.find('}') == std::string::npos) timed = true;
        if (!timed) bytes += line + "\n";
      }
    }
    out[fs::relative(entry.path(), folder).string()] = std::move(bytes);
  }
  return out;
}

bool is_temporary(const std::string& name) {
  return name.ends_with(".part") || name.ends_with(".lock") || name.find(".frames/") != std::string::npos;
}

/// How a run ended: exit code, or the signal as a negative number; -1000 when it hung.
int run(const std::string& program, const Job& job, const fs::path& folder, const std::vector<std::string>& environment,
        const std::vector<std::string>& more, double kill_after = -1) {
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.c_str()) != 0) _exit(99);
    const int log = open((folder.string() + ".log").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(log, 1);
    dup2(log, 2);
    for (const std::string& pair : environment) putenv(const_cast<char*>(pair.c_str()));
    std::vector<char*> arguments{const_cast<char*>(program.c_str())};
    for (const auto* list : {&job.arguments, &more})
      for (const std::string& argument : *list) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    _exit(98);
  }
  const auto start = std::chrono::steady_clock::now();
  bool killed = false;
  for (;;) {
    int status = 0;
    if (waitpid(child, &status, WNOHANG) == child) return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (kill_after >= 0 && seconds > kill_after && !killed) {
      kill(child, SIGKILL);
      killed = true;
    }
    if (seconds > kPatience) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return -1000;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
}

class Campaign {
 public:
  Campaign(std::string program, std::string shim, unsigned seed)
      : program_(std::move(program)), shim_(std::move(shim)), chance_(seed) {
    std::string pattern = (fs::temp_directory_path() / "crashreel_faults_XXXXXX").string();
    root_ = mkdtemp(pattern.data());
    std::ofstream(root_ / "ball.toml") << kScene;
    const std::string scene = (root_ / "ball.toml").string();
    const std::vector<std::string> picture{"--size", "64x64", "--quality", "draft", "-j", "2"};
    jobs_ = {{"film", {"render", scene, "-o", "film.mp4"}},
             {"film_frame_by_frame", {"render", scene, "-o", "film.mp4", "--resume"}},
             {"frames", {"render", scene, "-o", "frames"}},
             {"figures", {"figure", scene, "-o", "figures", "--size", "64x64", "--quality", "draft"}},
             {"results", {"simulate", scene, "-o", "results"}}};
    for (std::size_t i = 0; i < 3; ++i) jobs_[i].arguments.insert(jobs_[i].arguments.end(), picture.begin(), picture.end());
  }
  ~Campaign() { fs::remove_all(root_); }

  /// The undisturbed runs, and how often each makes each call.
  bool prepare() {
    for (Job& job : jobs_) {
      const fs::path folder = fresh();
      const auto start = std::chrono::steady_clock::now();
      if (run(program_, job, folder, {}, {}) != 0) return complain(job, "the undisturbed run fails");
      seconds_[job.name] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      wanted_[job.name] = files_in(folder);
      const fs::path counts = root_ / "counts";
      fs::remove(counts);
      run(program_, job, fresh(), {"LD_PRELOAD=" + shim_, "FAULT_FILE=" + counts.string()}, {});
      std::ifstream in(counts);
      std::size_t c = 0;
      for (long n = 0; in >> n; c = (c + 1) % std::size(kCalls)) job.calls[c] = std::max(job.calls[c], n);
    }
    return wanted_["film"] == wanted_["film_frame_by_frame"] || complain(jobs_[1], "makes another film than drawing at once");
  }

  void fault() {
    const Job& job = jobs_[random(jobs_.size())];
    const std::size_t call = random(std::size(kCalls));
    // every call of the few there are; the many allocations by sample
    const long at = 1 + static_cast<long>(random(static_cast<std::size_t>(std::max(1L, job.calls[call]))));
    disturb(job, call, at, random(2) == 1);
  }

  /// Fails each call of a kind, or each `every`-th. Whether there is such a kind.
  bool in_turn(const std::string& kind, long every) {
    const auto* call = std::find(std::begin(kCalls), std::end(kCalls), kind);
    if (call == std::end(kCalls)) return false;
    const auto c = static_cast<std::size_t>(call - std::begin(kCalls));
    for (const Job& job : jobs_) {
      std::printf("%s: %ld times %s\n", job.name.c_str(), job.calls[c], kind.c_str());
      std::fflush(stdout);
      for (long at = 1; at <= job.calls[c]; at += every) disturb(job, c, at, false);
    }
    return true;
  }

  void strike() {
    const Job& job = jobs_[random(jobs_.size())];
    const fs::path folder = fresh();
    const double within = 1.1 * seconds_[job.name];
    const double first = chance() * within;
    std::string what = "killed after " + std::to_string(first) + " s";
    look(job, folder, what, run(program_, job, folder, {}, {}, first));
    ++kills_;
    if (random(3) == 0) {
      const double second = chance() * within;
      what += " and " + std::to_string(second) + " s";
      look(job, folder, what, run(program_, job, folder, {}, resume(job), second));
      ++kills_in_resume_;
    }
    finish(job, folder, what);
  }

  int report() const {
    std::printf("%d faults (exit codes:", faults_);
    for (const auto& [code, times] : ended_) std::printf(" %d: %d times", code, times);
    std::printf("), %d kills and %d more during --resume, %d promises broken\n", kills_, kills_in_resume_, broken_);
    return broken_ == 0 ? 0 : 1;
  }

 private:
  std::size_t random(std::size_t below) { return static_cast<std::size_t>(chance_() % below); }
  double chance() { return static_cast<double>(chance_()) / static_cast<double>(std::mt19937::max()); }

  fs::path fresh() {
    fs::remove_all(root_ / "run");
    fs::create_directory(root_ / "run");
    return root_ / "run";
  }

  static std::vector<std::string> resume(const Job& job) {
    if (job.name == "film_frame_by_frame") return {};  // has it already
    // figures take a second and are made anew
    return {job.name == "figures" ? "--overwrite" : "--resume"};
  }

  void disturb(const Job& job, std::size_t call, long at, bool on) {
    const fs::path folder = fresh();
    const std::string what = std::string(kCalls[call]) + " " + std::to_string(at) + (on ? " and on" : "");
    const int code = run(program_, job, folder,
                         {"LD_PRELOAD=" + shim_, std::string("FAULT_CALL=") + kCalls[call], "FAULT_AT=" + std::to_string(at),
                          std::string("FAULT_ON=") + (on ? "on" : "once")},
                         {});
    ++faults_;
    ++ended_[code];
    if (code != 0 && code != 3) complain(job, what + ": ended with " + std::to_string(code), folder);
    look(job, folder, what, code);
    finish(job, folder, what);
  }

  bool complain(const Job& job, const std::string& what, const fs::path& folder = {}) {
    ++broken_;
    std::printf("%s: %s\n", job.name.c_str(), what.c_str());
    if (!folder.empty())
      std::printf("  %s\n",
                  std::string(std::istreambuf_iterator<char>(std::ifstream(folder.string() + ".log").rdbuf()), {}).c_str());
    std::fflush(stdout);
    return false;
  }

  void look(const Job& job, const fs::path& folder, const std::string& what, int code) {
    const Files found = files_in(folder);
    const Files& wanted = wanted_[job.name];
    for (const auto& [name, bytes] : found) {
      if (is_temporary(name)) continue;
      const auto same = wanted.find(name);
      if (same == wanted.end() || same->second != bytes) complain(job, what + ": " + name + " is not what it should be", folder);
    }
    if (code == 0 && found.size() != wanted.size())
      complain(job, what + ": exit code 0, but files are missing or left over", folder);
  }

  void finish(const Job& job, const fs::path& folder, const std::string& what) {
    const int code = run(program_, job, folder, {}, resume(job));
    if (code != 0) complain(job, what + ": --resume then ends with " + std::to_string(code), folder);
    if (files_in(folder) != wanted_[job.name])
      complain(job, what + ": --resume then leaves other files than an undisturbed run", folder);
  }

  std::string program_, shim_;
  std::mt19937 chance_;
  fs::path root_;
  std::vector<Job> jobs_;
  std::map<std::string, Files> wanted_;
  std::map<std::string, double> seconds_;
  std::map<int, int> ended_;
  int faults_ = 0, kills_ = 0, kills_in_resume_ = 0, broken_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  long faults = 0, kills = 0, seed = 1, every = 1;
  std::vector<std::string> kinds;
  for (int i = 3; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--in-turn")
      kinds.push_back(argv[i + 1]);
    else
      (name == "--faults" ? faults : name == "--kills" ? kills : name == "--every" ? every : seed) = std::atol(argv[i + 1]);
  }
  if (argc < 3) {
    std::fprintf(stderr, "fault_campaign PROGRAM SHIM --faults N --kills N [--seed N] | --in-turn CALL [--every N]\n");
    return 2;
  }
  // jobs run in folders of their own
  Campaign campaign(fs::absolute(argv[1]).string(), fs::absolute(argv[2]).string(), static_cast<unsigned>(seed));
  if (!campaign.prepare()) return 1;
  for (const std::string& kind : kinds)
    if (!campaign.in_turn(kind, std::max(1L, every))) return 2;
  for (long i = 0; i < faults; ++i) campaign.fault();
  for (long i = 0; i < kills; ++i) campaign.strike();
  return campaign.report();
}
