#include "cli/study/instructions.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace cli::study {

InstructionCounter::InstructionCounter() {
  perf_event_attr wish{};
  wish.type = PERF_TYPE_HARDWARE;
  wish.size = sizeof wish;
  wish.config = PERF_COUNT_HW_INSTRUCTIONS;
  wish.disabled = 1;
  wish.exclude_kernel = 1;
  wish.exclude_hv = 1;
  file_ = static_cast<int>(syscall(SYS_perf_event_open, &wish, 0, -1, -1, 0));
}

InstructionCounter::~InstructionCounter() {
  if (file_ >= 0) close(file_);
}

void InstructionCounter::start() {
  if (file_ < 0) return;
  ioctl(file_, PERF_EVENT_IOC_RESET, 0);
  ioctl(file_, PERF_EVENT_IOC_ENABLE, 0);
}

double InstructionCounter::stop() {
  if (file_ < 0) return 0;
  ioctl(file_, PERF_EVENT_IOC_DISABLE, 0);
  std::uint64_t count = 0;
  return read(file_, &count, sizeof count) == sizeof count ? static_cast<double>(count) : 0;
}

}  // namespace cli::study
