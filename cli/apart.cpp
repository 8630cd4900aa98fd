#include "cli/apart.h"

#include <fmt/format.h>

#include <new>

#include "cli/exit.h"
#include "cli/process.h"
#include "render/workers.h"

namespace cli {
namespace {

constexpr char kFailed = 'E', kWorked = 'W';  // heads a message; what follows are texts, each ended by a zero byte

std::string message_of(const std::function<std::vector<std::string>()>& work) {
  std::string message(1, kWorked);
  try {
    for (const std::string& text : work()) message += text + '\0';
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    message = kFailed + std::string(error.what()) + '\0';
  }
  return message;
}

}  // namespace

std::vector<std::string> apart(const std::string& what, const std::function<std::vector<std::string>()>& work) {
  render::TaskResult result;
  render::Workers(1, check_interrupted)
      .run(
          1, [&work](int, int) { return message_of(work); }, [&result](const render::TaskResult& found) { result = found; });
  const std::string& message = result.message;
  if (result.status != 0 || message.empty())
    throw MachineError(fmt::format("drawing {}: its process was ended, most likely for want of memory", what));
  std::vector<std::string> out;
  for (std::size_t at = 1; at < message.size(); at += out.back().size() + 1) out.emplace_back(message.c_str() + at);
  if (message[0] == kFailed) throw MachineError(out.front());
  return out;
}

}  // namespace cli
