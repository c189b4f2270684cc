#include "mailbox.hpp"

#include <utility>

namespace glocal::ros2_plugin {
namespace {

std::int64_t now_ns() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

Mailbox::Box& Mailbox::add(const LiveTopic& topic, const Limits& limits) {
  const std::lock_guard lock(mutex_);
  boxes_.push_back({*this, topic, limits});
  return boxes_.back();
}

Mailbox::Waiting Mailbox::first_of(Box& box) {
  Waiting first = std::move(box.waiting.front());
  box.waiting.pop_front();
  box.bytes -= ddsi_serdata_size(first.message.get());
  return first;
}

void Mailbox::put(Box& box, Received message) {
  const std::lock_guard lock(mutex_);
  box.bytes += ddsi_serdata_size(message.get());
  box.waiting.push_back({received_++, now_ns(), std::move(message)});
  const auto is_full = [&] {
    return box.waiting.size() > box.limits.messages ||
           (box.waiting.size() > 1 && box.bytes > box.limits.bytes);
  };
  while (is_full()) static_cast<void>(first_of(box));
  changed_.notify_one();
}

void Mailbox::note(std::string sentence) {
  const std::lock_guard lock(mutex_);
  news_.notes.push_back(std::move(sentence));
  changed_.notify_one();
}

void Mailbox::note_senders() {
  const std::lock_guard lock(mutex_);
  news_.senders = true;
  changed_.notify_one();
}

Mailbox::Box* Mailbox::oldest() {
  Box* found = nullptr;
  for (Box& box : boxes_) {
    if (box.waiting.empty()) continue;
    if (found == nullptr || box.waiting.front().number < found->waiting.front().number) found = &box;
  }
  return found;
}

Mailbox::News Mailbox::take(std::chrono::steady_clock::time_point until) {
  std::unique_lock lock(mutex_);
  Box* box = nullptr;
  changed_.wait_until(lock, until, [&] {
    box = oldest();
    return box != nullptr || news_.senders || !news_.notes.empty();
  });
  News news = std::exchange(news_, {});
  if (box == nullptr) return news;
  const Waiting first = first_of(*box);
  news.message = LiveMessage{box->topic, first.stamp_ns, {}};
  lock.unlock();  // Clouds take long to copy.
  std::string& bytes = news.message->bytes;
  bytes.resize(ddsi_serdata_size(first.message.get()));
  ddsi_serdata_to_ser(first.message.get(), 0, bytes.size(), bytes.data());
  return news;
}

Mailbox::News Mailbox::take_notes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

}  // namespace glocal::ros2_plugin
