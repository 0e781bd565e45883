#include "io/live_page.h"

#include <httplib.h>

#include <chrono>
#include <csignal>
#include <functional>

#include "base/error.h"
#include "io/replay_page.h"

namespace sumogamma {

namespace {

constexpr const char* kHost = "127.0.0.1";
// of viewers: what the page itself takes beside the streams, and how long one may keep a thread
// from going on
constexpr std::size_t kSpareThreads = 4;
constexpr std::chrono::seconds kPatience{2};
constexpr std::chrono::milliseconds kHeartbeat{500};
// kept for viewers that lag behind: so many stretches that each can be read by itself
constexpr std::size_t kStretches = 3;
constexpr std::size_t kMostAtOnce = 200;  // messages

/// A run's own signal handlers are for its main thread.
std::thread start_without_signals(std::function<void()> body) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(body));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

std::string message_of(const char* event, const std::string& bytes) {
  return std::string("event: ") + event + "\ndata: " + base64(bytes) + "\n\n";
}

}  // namespace

LivePage::LivePage(int port) : server_(std::make_unique<httplib::Server>()) {
  server_->set_address_family(AF_INET);
  // without SO_REUSEPORT, by which two runs would share a port
  server_->set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  server_->set_read_timeout(kPatience);
  server_->set_write_timeout(kPatience);
  server_->set_keep_alive_max_count(1);
  server_->set_payload_max_length(0);
  server_->new_task_queue = [] { return new httplib::ThreadPool(kMostViewers + kSpareThreads); };
  route();
  if (port == 0) {
    port_ = server_->bind_to_any_port(kHost);
  } else if (server_->bind_to_port(kHost, port)) {
    port_ = port;
  }
  if (port_ <= 0)
    throw Error("--serve " + std::to_string(port),
                "127.0.0.1:" + std::to_string(port) +
                    " can't be listened at, another program may be there: choose another port, or "
                    "none for any free one");
  thread_ = start_without_signals([this] { server_->listen_after_bind(); });
}

LivePage::~LivePage() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  // whoever reads gets the last word; others are left behind
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (viewers_ > 0 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  while (!server_->is_running() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  server_->stop();
  thread_.join();
}

void LivePage::route() {
  using httplib::Request, httplib::Response;
  server_->set_default_headers(
      {{"Cache-Control", "no-store"}, {"X-Content-Type-Options", "nosniff"}});
  // a page of somewhere else that calls this address by a name of its own gets nothing
  server_->set_pre_routing_handler([this](const Request& request, Response& response) {
    const std::string host = request.get_header_value("Host"), end = ":" + std::to_string(port_);
    if (host == kHost + end || host == "localhost" + end)
      return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    return httplib::Server::HandlerResponse::Handled;
  });
  server_->Get("/", [](const Request&, Response& response) {
    response.set_header("Content-Security-Policy",
                        "default-src 'none'; script-src 'unsafe-inline'; style-src "
                        "'unsafe-inline'; connect-src 'self'");
    response.set_content(live_replay_page(), "text/html; charset=utf-8");
  });
  server_->Get("/favicon.ico", [](const Request&, Response& response) { response.status = 204; });
  server_->Get("/events", [this](const Request&, Response& response) {
    if (++viewers_ > kMostViewers) {
      --viewers_;
      response.status = 503;
      response.set_content("as many viewers as there may be are there\n", "text/plain");
      return;
    }
    auto viewer = std::make_shared<Viewer>();
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, viewer](std::size_t, httplib::DataSink& sink) {
          const std::vector<Message> messages = wait_for(*viewer);
          for (const Message& message : messages)
            if (!sink.write(message->data(), message->size())) return false;
          if (viewer->told_of_end) sink.done();
          return true;
        },
        [this](bool) { --viewers_; });
  });
}

void LivePage::begin(const std::string& header) {
  const std::lock_guard lock(mutex_);
  header_ = std::make_shared<const std::string>(message_of("header", header));
}

void LivePage::append(Message message) {
  recent_.push_back(std::move(message));
  while (fresh_.size() > kStretches) fresh_.pop_front();
  while (!fresh_.empty() && first_ < fresh_.front()) {
    recent_.pop_front();
    ++first_;
  }
}

void LivePage::publish(const std::string& records, bool fresh) {
  if (records.empty()) return;
  auto message = std::make_shared<const std::string>(message_of("records", records));
  {
    const std::lock_guard lock(mutex_);
    if (fresh) fresh_.push_back(first_ + recent_.size());
    append(std::move(message));
  }
  changed_.notify_all();
}

void LivePage::publish_marks(const std::string& records) {
  if (records.empty()) return;
  auto message = std::make_shared<const std::string>(message_of("records", records));
  {
    const std::lock_guard lock(mutex_);
    marks_.push_back(message);
    if (marks_.size() > kMostMarks) marks_.pop_front();
    append(std::move(message));
  }
  changed_.notify_all();
}

std::vector<LivePage::Message> LivePage::wait_for(Viewer& viewer) {
  std::unique_lock lock(mutex_);
  const auto has_news = [&] {
    return over_ || (header_ && (!viewer.greeted || viewer.next < first_ + recent_.size()));
  };
  changed_.wait_for(lock, kHeartbeat, has_news);
  std::vector<Message> messages;
  if (header_ && !viewer.greeted) {
    messages.push_back(header_);
    messages.insert(messages.end(), marks_.begin(), marks_.end());
    viewer.greeted = true;
    // nothing that can be read by itself yet: from what comes next
    viewer.next = first_ + recent_.size();
    if (!fresh_.empty()) viewer.next = fresh_.back();
  }
  if (viewer.next < first_ && viewer.greeted) viewer.next = fresh_.empty() ? first_ : fresh_.back();
  for (; viewer.greeted && viewer.next < first_ + recent_.size(); ++viewer.next) {
    if (messages.size() >= kMostAtOnce + marks_.size()) break;
    messages.push_back(recent_[viewer.next - first_]);
  }
  static const auto kOver = std::make_shared<const std::string>("event: over\ndata:\n\n");
  static const auto kNothing = std::make_shared<const std::string>(":\n\n");
  if (over_) {
    messages.push_back(kOver);
    viewer.told_of_end = true;
  }
  if (messages.empty()) messages.push_back(kNothing);
  return messages;
}

}  // namespace sumogamma
