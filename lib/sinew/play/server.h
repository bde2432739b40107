// SPDX-License-Identifier: GPL-3.0-or-later
// A page in the browser of this machine, and a connection with it: HTTP and WebSocket on the
// loopback interface. Only who knows the token gets in, from a page of this address, one at a time.
//
//     PageServer server(page, {.port = 0}, [&](std::string message) { inbox.add(message); });
//     print(server.address());
//     if (server.wants_frame()) server.send_frame(bytes);
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace sinew {

struct PageServerOptions {
  int port = 0;  ///< 0: any that is free
};

class PageServer {
 public:
  /// What happens to a connection, in a thread of the server's own.
  struct Events {
    std::function<void()> opened;                             ///< a page has come in
    std::function<void(const std::string& message)> message;  ///< bytes: max_message at most
  };
  static constexpr std::size_t max_message = 16 << 10;

  /// Listens, and answers with `page`. Throws not written for a port that is taken.
  PageServer(std::string page, const PageServerOptions& options, Events events);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// http://127.0.0.1:PORT/#TOKEN
  std::string address() const;

  // Nothing of these waits; without a page nothing is sent.

  bool has_page() const;
  /// Sends a text. A page that does not read them is left.
  void send(std::string text);
  /// Whether the page has shown all frames that were sent, and waits for the next.
  bool wants_frame() const;
  void send_frame(std::string bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> its_;
};

}  // namespace sinew
