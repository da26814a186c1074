// One thread: it accepts, answers, reads the recording on, and sends what is new.
#include "viewer/live.h"

#include <utility>  // before Boost 1.74, which uses it without saying so
// clang-format off: the order matters
#include <boost/asio.hpp>
#include <boost/beast.hpp>
// clang-format on
#include <algorithm>
#include <charconv>
#include <chrono>
#include <deque>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "viewer/live_feed.h"
#include "viewer/page.h"

namespace avbd {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = net::ip::tcp;
using Failure = boost::system::error_code;
using live::Message;

constexpr auto kLookAgain = std::chrono::milliseconds(50);
constexpr auto kPatience = std::chrono::seconds(30);  // with a browser that says nothing half-way through a request
constexpr size_t kQuestionMost = 64;                  // bytes of a browser's message
constexpr uint32_t kFramesMost = 256;                 // asked for at once
constexpr size_t kQueueMost = 64u << 20;              // bytes that wait for a slow browser

/// What the connections share.
struct Shared {
  explicit Shared(const std::filesystem::path& recording) : feed(recording) {}
  live::Feed feed;
  uint16_t port = 0;
};

/// One browser's open socket.
class Watcher : public std::enable_shared_from_this<Watcher> {
 public:
  Watcher(beast::tcp_stream&& stream, Shared& shared) : socket_(std::move(stream)), shared_(shared) {}

  void start(const http::request<http::empty_body>& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(kQuestionMost);
    socket_.binary(true);
    socket_.async_accept(request, [self = shared_from_this()](Failure failed) {
      if (failed) return;
      self->open_ = true;
      self->sendNews();
      self->read();
    });
  }

  /// The head first, then figures of frames not sent yet.
  void sendNews() {
    if (!open_) return;
    if (!headSent_) {
      const Message head = shared_.feed.head();
      if (!head) return;
      headSent_ = true;
      send(head);
    }
    if (figuresSent_ >= shared_.feed.known() && finishedSent_ == shared_.feed.finished()) return;
    if (shared_.feed.finished() && !finishedSent_) send(shared_.feed.report());
    send(shared_.feed.figures(figuresSent_));
    figuresSent_ = shared_.feed.known();
    finishedSent_ = shared_.feed.finished();
  }

  void close() {
    open_ = false;
    beast::get_lowest_layer(socket_).close();
  }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](Failure failed, size_t) {
      if (failed) return;
      const std::string question = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (!self->answer(question)) return self->close();
      self->read();
    });
  }

  // "get FIRST END"; anything else is no page of ours.
  bool answer(std::string_view question) {
    uint32_t range[2];
    if (!question.starts_with("get ")) return false;
    const char *at = question.data() + 4, *end = question.data() + question.size();
    for (uint32_t& value : range) {
      const auto [next, failed] = std::from_chars(at, end, value);
      if (failed != std::errc()) return false;
      at = next < end ? next + 1 : next;
    }
    const uint32_t last = std::min({range[1], shared_.feed.known(), range[0] + kFramesMost});
    for (uint32_t i = range[0]; i < last && waiting_ < kQueueMost; ++i) send(shared_.feed.frame(i));
    return true;
  }

  void send(const Message& message) {
    queue_.push_back(message);
    waiting_ += message->size();
    if (queue_.size() == 1) write();
  }

  void write() {
    const Message& message = queue_.front();
    socket_.async_write(net::buffer(*message), [self = shared_from_this()](Failure failed, size_t) {
      if (failed) return;
      self->waiting_ -= self->queue_.front()->size();
      self->queue_.pop_front();
      if (!self->queue_.empty()) self->write();
    });
  }

  websocket::stream<beast::tcp_stream> socket_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  std::deque<Message> queue_;
  size_t waiting_ = 0;
  uint32_t figuresSent_ = 0;
  bool open_ = false, headSent_ = false, finishedSent_ = false;
};

/// One connection while it speaks HTTP.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  using Welcome = std::function<void(std::shared_ptr<Watcher>)>;
  Visitor(tcp::socket&& socket, Shared& shared, Welcome welcome)
      : stream_(std::move(socket)), shared_(shared), welcome_(std::move(welcome)) {}

  void read() {
    parser_.emplace();
    stream_.expires_after(kPatience);
    http::async_read_header(stream_, buffer_, *parser_, [self = shared_from_this()](Failure failed, size_t) {
      const bool unclear = failed.category() == http::make_error_code(http::error::bad_method).category();
      if (failed == http::error::end_of_stream || (failed && !unclear)) return self->stream_.close();
      if (failed) return self->respond(http::status::bad_request, "bad request\n", "text/plain", false);
      self->answer();
    });
  }

 private:
  // A page elsewhere may name this computer by another host and read along: only our own names are answered.
  bool isOwn(std::string_view host) const {
    const std::string port = ":" + std::to_string(shared_.port);
    return host == "127.0.0.1" + port || host == "localhost" + port;
  }

  void answer() {
    const auto& request = parser_->get();
    const auto field = [&](http::field name) {
      const auto text = request[name];
      return std::string_view(text.data(), text.size());
    };
    if (!isOwn(field(http::field::host)))
      return respond(http::status::forbidden, "not served under this name\n", "text/plain", false);
    const std::string_view target(request.target().data(), request.target().size());
    if (websocket::is_upgrade(request)) {
      const std::string_view origin = field(http::field::origin);
      if (target != "/stream" || (!origin.empty() && !(origin.starts_with("http://") && isOwn(origin.substr(7)))))
        return respond(http::status::forbidden, "no stream here\n", "text/plain", false);
      stream_.expires_never();
      const auto watcher = std::make_shared<Watcher>(std::move(stream_), shared_);
      welcome_(watcher);
      return watcher->start(http::request<http::empty_body>(request));
    }
    const bool keep = request.keep_alive();
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return respond(http::status::method_not_allowed, "only GET\n", "text/plain", false);
    if (target == "/favicon.ico") return respond(http::status::no_content, "", "image/x-icon", keep);
    if (target != "/") return respond(http::status::not_found, "nothing here; the page is at /\n", "text/plain", keep);
    std::ostringstream page;
    writeLivePage(page, shared_.port);
    respond(http::status::ok, page.str(), "text/html; charset=utf-8", keep);
  }

  void respond(http::status status, std::string body, const char* type, bool keep) {
    response_ = {};
    response_.result(status);
    response_.version(11);
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.keep_alive(keep);
    const bool bare = parser_->is_header_done() && parser_->get().method() == http::verb::head;
    response_.body() = std::move(body);
    response_.prepare_payload();
    if (bare) response_.body().clear();
    stream_.expires_after(kPatience);
    http::async_write(stream_, response_, [self = shared_from_this(), keep](Failure failed, size_t) {
      if (failed || !keep) return self->stream_.close();
      self->read();
    });
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  Welcome welcome_;
  beast::flat_buffer buffer_{16384};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

struct LiveServer::Impl {
  Impl() = default;
  void open(const std::filesystem::path& recording) { shared.emplace(recording); }
  void listen(uint16_t port) {
    const tcp::endpoint place(net::ip::address_v4::loopback(), port);
    try {
      acceptor.open(place.protocol());
      acceptor.set_option(net::socket_base::reuse_address(true));
      acceptor.bind(place);
      acceptor.listen();
    } catch (const boost::system::system_error& e) {
      throw std::runtime_error("port " + std::to_string(port) + ": " + e.code().message());
    }
  }
  ~Impl() {
    tasks.stop();
    if (thread.joinable()) thread.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void start() {
    shared->port = acceptor.local_endpoint().port();
    shared->feed.update();
    accept();
    look();
    thread = std::thread([this] { serve(); });
  }

  // What one connection throws ends that connection: its handler was the last to hold it.
  void serve() {
    while (!tasks.stopped()) {
      try {
        tasks.run();
      } catch (const std::exception&) {
      }
    }
  }

  void accept() {
    acceptor.async_accept([this](Failure failed, tcp::socket socket) {
      if (failed == net::error::operation_aborted) return;
      accept();
      if (failed) return;
      const auto welcome = [this](const std::shared_ptr<Watcher>& watcher) { watchers.push_back(watcher); };
      std::make_shared<Visitor>(std::move(socket), *shared, welcome)->read();
    });
  }

  void look() {
    timer.expires_after(kLookAgain);
    timer.async_wait([this](Failure failed) {
      if (failed) return;
      look();
      bool same = true;
      try {
        same = shared->feed.update();
      } catch (const std::exception&) {
        // The file cannot be read at the moment; what is known stays on show.
      }
      std::erase_if(watchers, [](const auto& watcher) { return watcher.expired(); });
      for (const auto& weak : watchers) {
        const auto watcher = weak.lock();
        if (!watcher) continue;
        if (same)
          tell(*watcher);
        else
          watcher->close();  // the page asks again and begins anew
      }
    });
  }

  // What cannot be told to one must not keep it from the others.
  static void tell(Watcher& watcher) {
    try {
      watcher.sendNews();
    } catch (const std::exception&) {
      watcher.close();
    }
  }

  std::optional<Shared> shared;
  net::io_context tasks{1};
  tcp::acceptor acceptor{tasks};
  net::steady_timer timer{tasks};
  std::vector<std::weak_ptr<Watcher>> watchers;
  std::thread thread;
};

LiveServer::LiveServer(const std::filesystem::path& recording, uint16_t port) : impl_(std::make_unique<Impl>()) {
  impl_->open(recording);
  impl_->listen(port);
  impl_->start();
}

LiveServer::LiveServer(uint16_t port) : impl_(std::make_unique<Impl>()) { impl_->listen(port); }

LiveServer::~LiveServer() = default;

void LiveServer::show(const std::filesystem::path& recording) {
  impl_->open(recording);
  impl_->start();
}

uint16_t LiveServer::port() const { return impl_->acceptor.local_endpoint().port(); }

std::string LiveServer::url() const { return "http://127.0.0.1:" + std::to_string(port()) + "/"; }

}  // namespace avbd
