// Processes that work for this one: one task each, side by side. One that dies takes no other with it, and none outlives this
// process.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

namespace render {

/// A process forked from this one. It is killed when this one dies, and when the object goes.
class Worker {
 public:
  /// Forks; `life` runs in the child and its result is the exit code. Throws RenderError.
  explicit Worker(const std::function<int()>& life);
  ~Worker();
  Worker(Worker&& other) noexcept;
  Worker& operator=(Worker&& other) noexcept;

  pid_t pid() const { return pid_; }
  /// Whether it has ended, without waiting; then `status` is that of waitpid.
  bool has_ended(int& status);
  /// Its end, as of waitpid.
  int wait();

 private:
  pid_t pid_ = -1;
};

/// "Killed", "exit code 3": how a process ended, in words.
std::string ending(int status);

/// What a task came to.
struct TaskResult {
  int task = 0;
  int status = 0;       // as of waitpid; 0: it ended well
  std::string message;  // what it returned, whole where it ended well
};

/// Tasks in processes of their own, `jobs` at once.
class Workers {
 public:
  /// `look_around` is called some times a second while tasks run, and ends all by throwing.
  explicit Workers(int jobs, std::function<void()> look_around = {});

  /// Runs task(0) to task(count - 1), each in a process; `on_result` gets what they returned here, in the order in which they end.
  /// A place is a number below `jobs` that no other task has at the same time: a core, say. A task that throws ends with exit
  /// code 1. Throws RenderError where no process can be started, and what `look_around` and `on_result` throw; the others are then
  /// killed.
  void run(int count, const std::function<std::string(int task, int place)>& task,
           const std::function<void(const TaskResult&)>& on_result);

 private:
  int jobs_;
  std::function<void()> look_around_;
};

}  // namespace render
