// crashreel-cage NAME CPU_SECONDS MEMORY: reads one foreign mesh behind walls, and tells the parent what
// stands in it. Started by import_in_cage with a socket as descriptor 3 and a word to the allocator; by hand it does nothing.
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "scenes/cage/files.h"
#include "scenes/cage/protocol.h"
#include "scenes/cage/tasks.h"
#include "scenes/cage/walls.h"

namespace {

using namespace scenes::cage;

std::string answer_to(const std::string& name) {
  try {
    return mesh(name);
  } catch (const std::bad_alloc&) {  // more than any memory
    _exit(kNoMemory);
  } catch (const std::exception& error) {
    return std::string("E") + error.what();
  }
}

}  // namespace

int main(int argc, char** argv) {
  int kind = 0;
  socklen_t size = sizeof kind;
  if (argc != 4 || getsockopt(kSocket, SOL_SOCKET, SO_TYPE, &kind, &size) != 0) return 2;
  clearenv();  // the allocator has read its word
  // at the first refusal: an importer may swallow the exception, or throw it where none may pass
  std::set_new_handler([] { _exit(kNoMemory); });
  const std::uint32_t walls = raise_walls({std::strtoul(argv[2], nullptr, 10), std::strtoul(argv[3], nullptr, 10)});
  const std::string answer = answer_to(argv[1]);
  const Header header{Header::result, walls, answer.size()};
  const bool said = tell(&header, sizeof header) && tell(answer.data(), answer.size());
  _exit(said ? 0 : 1);
}
