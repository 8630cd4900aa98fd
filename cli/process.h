// The program as a process among others: its standard streams, the signals that stop it.
#pragma once

#include <stdexcept>
#include <string>

namespace cli {

/// Somebody asked the program to stop (Ctrl-C, a batch system). Exit code 128 + signal, as shells count.
struct Interrupted : std::runtime_error {
  explicit Interrupted(int signal);
  int signal;
};

/// To be called first. Nothing printed can end up in an output file or end the program, whatever was closed before it was started;
/// control characters of a scene's texts are shown as question marks;
/// a full disk, a file-size limit or a reader that went away is an error of the call that met it; SIGINT, SIGTERM and SIGHUP are
/// noted for the functions below.
void prepare_process();

/// Our own moves of the cursor, past what makes texts harmless. Lost where it cannot be written.
void write_to_terminal(const std::string&);

/// What the message of Interrupted says is left of the work: "nothing was kept" unless a command says otherwise.
void tell_when_stopped(const std::string& kept);

/// A file to remove should the program end from within a signal's handler, where no destructor runs. The text must stay where it is
/// until keep_when_stopped.
void remove_when_stopped(const char* path);
void keep_when_stopped(const char* path);

/// Whether a signal asked to stop. Cheap: for loops.
bool interrupted();
/// Throws Interrupted if one did.
void check_interrupted();

}  // namespace cli
