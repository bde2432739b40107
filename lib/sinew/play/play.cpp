// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/play.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include <sinew/play/conversation.h>
#include <sinew/play/page.h>
#include <sinew/play/server.h>
#include <sinew/run/run_folder.h>

namespace sinew {
namespace {

/// What comes from the page, for the thread that steps.
class Inbox {
 public:
  static constexpr std::size_t max_waiting = 10'000;

  void add(std::string message) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < max_waiting) waiting_.push_back(std::move(message));
    changed_.notify_one();
  }
  std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }
  void wait(std::chrono::steady_clock::duration longest) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, longest, [this] { return !waiting_.empty(); });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> waiting_;
};

}  // namespace

void play(const PlayOptions& options) {
  const RunFolder folder{options.folder};
  const FolderLock lock(folder, create(folder));
  Inbox inbox;
  PageServer* page = nullptr;
  Conversation talk(options, [&](const std::string& text) {
    if (page != nullptr) page->send(text);
  });
  PageServer server(play_page(), PageServerOptions{options.port},
                    {[&] { inbox.add(R"({"do":"hello"})"); },
                     [&](const std::string& message) { inbox.add(message); }});
  page = &server;
  if (options.ready) options.ready(server.address());
  while (!options.stop_requested || !options.stop_requested()) {
    for (const std::string& message : inbox.take()) talk.take(message);
    if (talk.is_due()) talk.advance();
    talk.answer_turns();
    const bool wanted = server.has_page() && server.wants_frame();
    if (wanted)
      if (auto frame = talk.frame()) server.send_frame(*std::move(frame));
    talk.keep(false);
    if (!talk.is_due()) inbox.wait(talk.until_due(wanted));
  }
  talk.keep(true);
}

}  // namespace sinew
