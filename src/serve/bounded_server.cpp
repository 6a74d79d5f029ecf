// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/bounded_server.hpp"

#include "serve/answers.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <string_view>

namespace rhizodont::serve {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t bytes_per_second = std::size_t{64} << 10;  // slower bodies are given up
constexpr auto most_lingering = std::chrono::seconds(2);

/// Waits for an event of the socket; false when the time is over.
bool wait_for(socket_t socket, short event, Clock::time_point until) {
  while (true) {
    const auto left = std::chrono::duration_cast<milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    pollfd asked{socket, event, 0};
    const int ready = poll(&asked, 1, static_cast<int>(std::min<std::int64_t>(left, 60'000)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

enum class Ending { none, closed, head_too_long, too_slow };

class BoundedStream : public httplib::Stream {
 public:
  BoundedStream(socket_t socket, const ServeLimits& limits)
      : socket_(socket), limits_(limits), begun_(Clock::now()), answer_until_(Clock::time_point::max()) {}

  bool is_readable() const override {
    return next_ < filled_ || wait_for(socket_, POLLIN, Clock::now() + milliseconds(1));
  }

  /// Also false when the client has gone away.
  bool is_writable() const override {
    pollfd asked{socket_, POLLOUT | POLLRDHUP, 0};
    return poll(&asked, 1, 0) > 0 && (asked.revents & (POLLRDHUP | POLLHUP | POLLERR)) == 0 &&
           Clock::now() < answer_until_;
  }

  ssize_t read(char* into, std::size_t size) override {
    if (next_ == filled_ && !fill()) return ending_ == Ending::closed ? 0 : -1;
    const std::size_t count = std::min(size, filled_ - next_);
    std::memcpy(into, buffer_.data() + next_, count);
    next_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* bytes, std::size_t size) override {
    if (!has_written_) answer_until_ = Clock::now() + limits_.answer_time;
    has_written_ = true;
    if (!wait_for(socket_, POLLOUT, std::min(answer_until_, Clock::now() + limits_.stall_time))) return -1;
    return send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override {  // of this machine; nobody needs to know
    ip.clear();
    port = 0;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override { get_remote_ip_and_port(ip, port); }
  socket_t socket() const override { return socket_; }

  bool has_written() const { return has_written_; }
  bool has_read() const { return received_ > 0; }
  Ending ending() const { return ending_; }

  /// Lets the client read the answer while it is still sending.
  void linger() {
    shutdown(socket_, SHUT_WR);
    const auto until = Clock::now() + most_lingering;
    while (wait_for(socket_, POLLIN, until) && recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT) > 0) {
    }
  }

 private:
  bool fill() {
    const auto time = limits_.request_time + std::chrono::seconds(head_ended_ ? received_ / bytes_per_second : 0);
    if (ending_ != Ending::none) return false;
    if (!wait_for(socket_, POLLIN, begun_ + time)) {
      ending_ = Ending::too_slow;
      return false;
    }
    const ssize_t count = recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (count <= 0) {
      ending_ = Ending::closed;
      return false;
    }
    next_ = 0;
    filled_ = static_cast<std::size_t>(count);
    received_ += filled_;
    if (!head_ended_) follow_head();
    if (!head_ended_ && received_ > limits_.header_bytes) ending_ = Ending::head_too_long;
    return ending_ == Ending::none;
  }

  void follow_head() {
    constexpr std::string_view end = "\r\n\r\n";
    for (std::size_t i = 0; i < filled_ && !head_ended_; ++i) {
      const char c = buffer_[i];
      matched_ = c == end[matched_] ? matched_ + 1 : static_cast<std::size_t>(c == '\r' ? 1 : 0);
      head_ended_ = matched_ == end.size();
    }
  }

  socket_t socket_;
  const ServeLimits& limits_;
  Clock::time_point begun_, answer_until_;
  std::array<char, 16384> buffer_{};
  std::size_t next_ = 0, filled_ = 0, received_ = 0, matched_ = 0;
  bool head_ended_ = false, has_written_ = false;
  Ending ending_ = Ending::none;
};

void answer_unanswered(BoundedStream& stream) {
  const int status = stream.ending() == Ending::too_slow ? 408 : stream.ending() == Ending::head_too_long ? 431 : 400;
  const std::string body = refusal_body(status, sentence_for_status(status));
  std::string answer = "HTTP/1.1 " + std::to_string(status) +
                       " Refused"
                       "\r\nContent-Type: application/json\r\nConnection: close\r\nContent-Length: " +
                       std::to_string(body.size()) + "\r\n\r\n" + body;
  stream.write(answer.data(), answer.size());
}

}  // namespace

BoundedServer::BoundedServer(const ServeLimits& limits) : limits_(limits) {
  new_task_queue = [count = limits.connections] { return new httplib::ThreadPool(count); };
  set_payload_max_length(limits.upload_bytes);
  set_socket_options([](socket_t socket) {  // httplib's own let two services share a port
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
}

bool BoundedServer::process_and_close_socket(socket_t socket) {
  BoundedStream stream(socket, limits_);
  bool closed = false;
  try {
    process_request(stream, true, closed, [](httplib::Request& request) {
      request.ranges.clear();  // httplib would cut refusals into parts, too
    });
  } catch (...) {  // what httplib throws of a request that it cannot take apart
    closed = true;
  }
  if (!stream.has_written() && stream.has_read()) answer_unanswered(stream);
  stream.linger();
  close(socket);
  return true;
}

}  // namespace rhizodont::serve
