#include "scenes/cage/files.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "scenes/cage/protocol.h"

namespace scenes::cage {
namespace {

/// The parent's answer: a descriptor, or -1.
int receive() {
  char byte = 0;
  iovec piece{&byte, 1};
  alignas(cmsghdr) char room[CMSG_SPACE(sizeof(int))];
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = room;
  message.msg_controllen = sizeof room;
  ssize_t n = 0;
  do n = recvmsg(kSocket, &message, 0);
  while (n < 0 && errno == EINTR);
  const cmsghdr* head = n == 1 && byte == kHere ? CMSG_FIRSTHDR(&message) : nullptr;
  if (!head || head->cmsg_type != SCM_RIGHTS) return -1;
  int handle = -1;
  std::memcpy(&handle, CMSG_DATA(head), sizeof handle);
  return handle;
}

}  // namespace

bool tell(const void* data, std::size_t bytes) {
  for (const char* at = static_cast<const char*>(data); bytes > 0;) {
    const ssize_t n = write(kSocket, at, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

std::optional<std::string> fetch(const std::string& name) {
  const Header header{Header::open_file, 0, name.size()};
  if (!tell(&header, sizeof header) || !tell(name.data(), name.size())) return std::nullopt;
  const int handle = receive();
  if (handle < 0) return std::nullopt;
  std::string out;
  char piece[1 << 16];
  for (;;) {
    const ssize_t n = read(handle, piece, sizeof piece);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    out.append(piece, static_cast<std::size_t>(n));
  }
  close(handle);
  return out;
}

}  // namespace scenes::cage
