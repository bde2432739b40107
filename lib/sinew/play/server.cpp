// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/server.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include <sinew/core/error.h>

namespace sinew {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Failure = beast::error_code;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::size_t max_texts = 1000;      // unread
constexpr std::size_t max_connections = 16;  // at once, whatever they are for
constexpr std::uint32_t max_header = 8 << 10, max_body = 1 << 10;
constexpr auto patience = std::chrono::seconds(10);

/// 128 random bits, of [0-9a-f].
std::string new_token() {
  std::random_device random;
  std::string token;
  for (int k = 0; k < 4; ++k) {
    std::uint32_t bits = random();
    for (int digit = 0; digit < 8; ++digit, bits >>= 4) token += "0123456789abcdef"[bits & 15];
  }
  return token;
}

/// In a time that does not tell how much of it is right.
bool is_same(std::string_view given, std::string_view token) {
  if (given.size() != token.size()) return false;
  unsigned char differs = 0;
  for (std::size_t k = 0; k < token.size(); ++k)
    differs = static_cast<unsigned char>(differs | (given[k] ^ token[k]));
  return differs == 0;
}

std::string_view text_of(boost::string_view text) { return {text.data(), text.size()}; }

/// Whether a Host names this machine: names of others may lead here (DNS rebinding).
bool is_loopback(std::string_view host) {
  const auto colon = host.rfind(':');
  const std::string_view name = host.substr(0, colon);
  return name == "127.0.0.1" || name == "localhost";
}

/// Whether a request comes from a page of this address.
bool is_own(const Request& request) {
  const std::string_view host = text_of(request[http::field::host]);
  const std::string_view origin = text_of(request[http::field::origin]);
  return is_loopback(host) && origin == "http://" + std::string(host);
}

/// "/live?token=...&take=1": the value of a name; "" without.
std::string_view argument(std::string_view target, std::string_view name) {
  for (auto at = target.find('?'); at != target.npos; at = target.find('&', at + 1)) {
    const std::string_view rest = target.substr(at + 1);
    if (rest.substr(0, name.size()) == name && rest.substr(name.size(), 1) == "=")
      return rest.substr(name.size() + 1, rest.find('&') - name.size() - 1);
  }
  return "";
}

}  // namespace

struct PageServer::Impl {
  class Connection;

  Impl(std::string with_page, const PageServerOptions& options, Events on)
      : page(std::move(with_page)), events(std::move(on)), acceptor(context) {
    Failure failed;
    const tcp::endpoint here(asio::ip::address_v4::loopback(),
                             static_cast<unsigned short>(options.port));
    acceptor.open(here.protocol(), failed);
    acceptor.set_option(asio::socket_base::reuse_address(true), failed);
    acceptor.bind(here, failed);
    if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
    if (failed)
      throw not_written("port " + std::to_string(options.port), failed.message(),
                        "choose another one with --port, or none");
    accept();
    thread = std::thread([this] { context.run(); });
  }
  ~Impl() {
    context.stop();
    thread.join();
  }

  void accept();
  void open(const std::shared_ptr<Connection>& connection);

  const std::string page;
  const std::string token = new_token();
  const Events events;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  std::shared_ptr<Connection> live;  ///< the page, if there is one
  std::size_t connections = 0;
  std::atomic<bool> has_page = false, wants_frame = false;
  std::thread thread;
};

/// One connection; all of it happens in the server's thread.
class PageServer::Impl::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Impl& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    ++server_.connections;
  }
  ~Connection() { --server_.connections; }

  void begin() {
    parser_.header_limit(max_header);
    parser_.body_limit(max_body);
    beast::get_lowest_layer(stream_).expires_after(patience);
    http::async_read(stream_.next_layer(), buffer_, parser_,
                     [self = shared_from_this()](Failure failed, std::size_t) {
                       if (!failed) self->answer(self->parser_.release());
                     });
  }

  void send(std::string text) {
    if (texts_.size() >= max_texts) return leave();
    texts_.push_back(std::move(text));
    write();
  }
  void send_frame(std::string bytes) {
    frame_ = std::move(bytes);
    write();
  }
  /// Closes the way to a page that another has taken the place of, or that does not read.
  void leave() {
    beast::get_lowest_layer(stream_).socket().close(ignored_);
    if (server_.live.get() == this) {
      server_.live.reset();
      server_.has_page = server_.wants_frame = false;
    }
  }
  /// Tells it why, as far as it reads, and closes.
  void take_leave(std::string why) {
    leaving_ = true;
    send(std::move(why));
  }

 private:
  void answer(Request request) {
    request_ = std::move(request);
    const std::string_view target = text_of(request_.target());
    if (!is_loopback(text_of(request_[http::field::host])))
      return respond(http::status::forbidden, "This address is not that of sinew play.\n");
    if (websocket::is_upgrade(request_)) {
      if (target.substr(0, 6) != "/live?" || !is_own(request_) ||
          !is_same(argument(target, "token"), server_.token))
        return respond(http::status::forbidden, "This page may not pose.\n");
      return upgrade(argument(target, "take") == "1");
    }
    if (request_.method() != http::verb::get || target != "/")
      return respond(http::status::not_found, "There is nothing here.\n");
    respond(http::status::ok, server_.page);
  }

  void respond(http::status status, std::string text) {
    response_ = Response(status, request_.version());
    response_.set(http::field::content_type,
                  status == http::status::ok ? "text/html; charset=utf-8" : "text/plain");
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Referrer-Policy", "no-referrer");
    response_.keep_alive(false);
    response_.body() = std::move(text);
    response_.prepare_payload();
    http::async_write(stream_.next_layer(), response_,
                      [self = shared_from_this()](Failure, std::size_t) {
                        beast::get_lowest_layer(self->stream_)
                            .socket()
                            .shutdown(tcp::socket::shutdown_send, self->ignored_);
                      });
  }

  void upgrade(bool takes) {
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{patience, std::chrono::seconds(60), true});
    stream_.read_message_max(max_message);
    stream_.auto_fragment(false);
    stream_.async_accept(request_, [self = shared_from_this(), takes](Failure failed) {
      if (failed) return;
      if (self->server_.live && !takes) return self->take_leave(R"({"busy":true})");
      self->server_.open(self);
      self->read();
    });
  }

  void read() {
    buffer_.consume(buffer_.size());
    stream_.async_read(buffer_, [self = shared_from_this()](Failure failed, std::size_t) {
      if (failed) return self->leave();
      if (self->server_.live != self) return;
      const std::string message = beast::buffers_to_string(self->buffer_.data());
      if (message == "more")
        self->server_.wants_frame = true;
      else
        self->server_.events.message(message);
      self->read();
    });
  }

  /// Texts first; one at a time, which is kept until it has gone.
  void write() {
    if (writing_) return;
    if (texts_.empty() && frame_.empty()) {
      if (leaving_) leave();
      return;
    }
    const bool text = !texts_.empty();
    if (text) {
      going_ = std::move(texts_.front());
      texts_.pop_front();
    } else {
      going_ = std::exchange(frame_, {});
    }
    writing_ = true;
    stream_.text(text);
    stream_.async_write(asio::buffer(going_),
                        [self = shared_from_this()](Failure failed, std::size_t) {
                          self->writing_ = false;
                          if (failed) return self->leave();
                          self->write();
                        });
  }

  Impl& server_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_{2 * max_message};
  http::request_parser<http::string_body> parser_;
  Request request_;
  Response response_;
  std::deque<std::string> texts_;
  std::string frame_, going_;
  bool writing_ = false, leaving_ = false;
  Failure ignored_;
};

void PageServer::Impl::accept() {
  acceptor.async_accept([this](Failure failed, tcp::socket socket) {
    if (!failed && connections < max_connections)
      std::make_shared<Connection>(*this, std::move(socket))->begin();
    accept();
  });
}

void PageServer::Impl::open(const std::shared_ptr<Connection>& connection) {
  if (live) live->take_leave(R"({"taken":true})");
  live = connection;
  has_page = true;
  wants_frame = false;
  events.opened();
}

PageServer::PageServer(std::string page, const PageServerOptions& options, Events events)
    : its_(std::make_unique<Impl>(std::move(page), options, std::move(events))) {}
PageServer::~PageServer() = default;

std::string PageServer::address() const {
  return "http://127.0.0.1:" + std::to_string(its_->acceptor.local_endpoint().port()) + "/#" +
         its_->token;
}

bool PageServer::has_page() const { return its_->has_page; }
bool PageServer::wants_frame() const { return its_->wants_frame; }

void PageServer::send(std::string text) {
  asio::post(its_->context, [its = its_.get(), text = std::move(text)]() mutable {
    if (its->live) its->live->send(std::move(text));
  });
}

void PageServer::send_frame(std::string bytes) {
  its_->wants_frame = false;
  asio::post(its_->context, [its = its_.get(), bytes = std::move(bytes)]() mutable {
    if (its->live) its->live->send_frame(std::move(bytes));
  });
}

}  // namespace sinew
