// Instructions a piece of work takes: a cost that other programs on the machine do not disturb. Where the system does not let a
// program count its own, there is none.
#pragma once

namespace cli::study {

class InstructionCounter {
 public:
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  void start();
  /// Instructions since start; 0 if they cannot be counted.
  double stop();

 private:
  int file_ = -1;
};

}  // namespace cli::study
