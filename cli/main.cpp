// crashreel: reads the command line and holds the only place where errors end.
#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "cli/allocation.h"
#include "cli/command.h"
#include "cli/commit.h"
#include "cli/exit.h"
#include "cli/findings.h"
#include "cli/process.h"
#include "render/error.h"
#include "render/frames.h"
#include "scenes/error.h"

namespace {

int report(const char* message, cli::ExitCode code) {
  // a command tells its own name: "crashreel render: unknown option --siz"
  const bool named = std::string_view(message).starts_with("crashreel ");
  fmt::print(stderr, "{}{}\n", named ? "" : "crashreel: ", message);
  return code;
}

/// Results that standard output did not take. Who reads no further, as `head` does, knows why there is no more.
int report_output(std::errc why) {
  if (why == std::errc::broken_pipe) return 128 + SIGPIPE;
  return report(("writing the result to standard output: " + std::make_error_code(why).message()).c_str(), cli::kMachineFailed);
}

}  // namespace

int main(int argc, char** argv) {
  cli::prepare_process();
  cli::end_where_memory_ends();
  cli::set_commit(cli::commit_of_build());
  try {
    const int code = cli::run_command_line(argc, argv);
    // a full disk or a closed pipe shows only when the buffer is written
    if (std::fflush(stdout) != 0) return report_output(std::errc(errno));
    return code;
  } catch (const scenes::SceneErrors& errors) {
    for (const scenes::Finding& finding : errors.findings) fmt::print(stderr, "{}", cli::finding_text(finding));
    return cli::kAuthorErred;
  } catch (const cli::UsageError& error) {
    return report(error.what(), cli::kAuthorErred);
  } catch (const render::FilmTooLong& error) {
    return report(error.what(), cli::kAuthorErred);
  } catch (const cli::MachineError& error) {
    return report(error.what(), cli::kMachineFailed);
  } catch (const render::RenderError& error) {
    return report(error.what(), cli::kMachineFailed);
  } catch (const cli::Interrupted& stop) {
    report(stop.what(), cli::kDone);
    return 128 + stop.signal;
  } catch (const std::bad_alloc&) {
    return report("not enough memory; a smaller size, fewer jobs or a longer recording interval need less", cli::kMachineFailed);
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::broken_pipe) return report_output(std::errc::broken_pipe);
    return report(error.what(), cli::kMachineFailed);
  } catch (const std::exception& error) {
    // out of memory, a file system that fails: nothing a scene or a command line could do
    return report(error.what(), cli::kMachineFailed);
  }
}
